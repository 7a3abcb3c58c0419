"""Everything on the bus into one self-explaining MCAP file."""
