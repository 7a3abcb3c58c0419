"""A router that nobody refers to any more must not stop the process while other sessions call back into Python."""

import subprocess
import sys

SCRIPT = """
import threading
from runtime.bus import direct, free_endpoint, open_peer, open_router

endpoint = free_endpoint()
with open_router(endpoint), open_peer(endpoint) as hearer, open_peer(endpoint) as speaker:
    hearer.declare_subscriber("said", direct(lambda sample: sum(range(2000))))
    said, over = speaker.declare_publisher("said"), threading.Event()

    def speak():
        while not over.wait(0.0005):
            for _ in range(20):
                said.put(b"word")

    speaking = threading.Thread(target=speak)
    speaking.start()
    for _ in range(20):
        open_router(free_endpoint()).close()
    over.set()
    speaking.join()
print("over")
"""


def test_a_router_is_forgotten_while_others_are_called_back() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout == "over\n", done.stderr
