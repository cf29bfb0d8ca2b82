import os
import signal
import subprocess
import sys

STUBBORN = """
import multiprocessing, os, signal, sys, time
from windup.tools.terminal.parallel import run_parallel

def work(item):
    signal.signal(signal.SIGTERM, lambda *_: None)  # as a robot's loop, which ends in its own time
    os.write(1, b"%d\\n" % os.getpid())  # at once, or the lines of two would mix
    time.sleep(600.0)

if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        list(run_parallel(work, [1, 2, 3, 4], label="x", jobs=2))
    except KeyboardInterrupt:
        sys.exit(130)
"""


def test_whoever_is_told_to_end_leaves_no_process_behind() -> None:
    with subprocess.Popen([sys.executable, "-c", STUBBORN], stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        workers = [int(parent.stdout.readline()) for _ in range(2)]
        for pid in workers:
            os.kill(pid, signal.SIGTERM)  # as a service manager does, to all of them
        parent.terminate()
        assert parent.wait(60) == 130
        assert not parent.stdout.read()
    for pid in workers:
        assert not os.path.exists(f"/proc/{pid}")
