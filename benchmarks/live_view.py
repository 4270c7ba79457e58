"""What the live view costs: CPU time of the server for each frame sent, beside the engine's own.

Run ``python benchmarks/live_view.py``. A page that draws nothing takes frames as fast as they come.
"""

import json
import statistics
import time
from multiprocessing import get_context

import carom
from carom import scenes
from carom.view import LiveView
from carom.view.wire import VERSION

SIZES = (100, 1_000, 10_000, 100_000)
FRAMES = 200


def take_frames(url, count):
    """A page in a process of its own, so that its work is not counted."""
    from websockets.sync.client import connect

    base, token = url.split("/#token=")
    address = base.replace("http", "ws") + "/live"
    with connect(address, origin=base, max_size=None, compression=None) as socket:
        socket.send(json.dumps({"op": "hello", "token": token, "version": VERSION}))
        while count > 0:
            socket.send(json.dumps({"op": "credit", "count": 1}))
            while isinstance(message := socket.recv(), str) or message[6] != 1:
                pass
            count -= 1


def measure(n):
    """Milliseconds of CPU for each frame: making it, and sending it."""
    sim = carom.Simulation(scenes.fluid(n=n, packing_fraction=0.3))
    with LiveView(sim) as view:
        driver, making = view._driver, []
        hand_out = driver._hand_out

        def timed():
            start = time.thread_time()
            hand_out()
            making.append(1e3 * (time.thread_time() - start))

        driver._hand_out = timed
        page = get_context("spawn").Process(target=take_frames, args=(view.url, 10))
        page.start()
        page.join()
        web = time.pthread_getcpuclockid(view._server._thread.ident)
        making.clear()
        start = time.clock_gettime(web)
        page = get_context("spawn").Process(target=take_frames, args=(view.url, FRAMES))
        page.start()
        page.join()
        sending = 1e3 * (time.clock_gettime(web) - start) / FRAMES
    return statistics.mean(making), sending


def main():
    """Print a table."""
    print("    spheres   making, ms   sending, ms   together, ms")
    for n in SIZES:
        making, sending = measure(n)
        print(f"{n:>11,}{making:13.3f}{sending:14.3f}{making + sending:15.3f}")


if __name__ == "__main__":
    main()
