"""Pictures for another host, as good and as many as the link carries without delaying what matters."""
