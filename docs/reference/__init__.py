"""The reference pages, written from the code whenever the documentation is built."""
