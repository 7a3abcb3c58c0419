"""What a session's file tells a person: numbers, pictures, one page."""
