"""The protocol of ActivMedia's robots (Pioneer, PeopleBot) and its client, pure: bytes and times in, bytes out."""
