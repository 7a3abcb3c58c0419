"""What a running or recorded session looks like: one pure fold of its messages, and viewers that show it."""
