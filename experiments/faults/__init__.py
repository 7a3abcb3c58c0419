"""The fault campaign: what is done to a running system, and what must hold nevertheless."""
