"""One folder = one process. `ports.py` declares, `core.py` computes, `component.py` joins the two."""
