#!/usr/bin/env python3
"""A sweep by Dask: parts_by_dask.py SWEEP.toml FOLDER PARTS [SCHEDULER]

Every task runs its part of the sweep into one folder that all workers see; the last step puts the parts together. SCHEDULER is
the address of one that runs, as tcp://host:8786; without it the workers are on this machine. A worker that is lost has its part
started again by another one, where it was.
"""

import subprocess
import sys

from dask.distributed import Client, progress


def run(*words):
    subprocess.run(["firmware-host", "sweep", *words], check=True)


def main(sweep, folder, parts, scheduler=None):
    parts = int(parts)
    # A process a worker, each with one thread: a part runs on as many threads as --threads says.
    with Client(scheduler) if scheduler else Client(threads_per_worker=1) as client:

        def part(i):
            run(sweep, "--out", folder, "--shard", f"{i}/{parts}", "--threads", "1")

        # Not pure: a part that was run in an earlier campaign is asked for again, and finds what is done.
        tasks = client.map(part, range(1, parts + 1), pure=False, retries=2)
        progress(tasks)
        client.gather(tasks)
    run(sweep, "--out", folder)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:])
