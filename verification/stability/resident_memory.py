"""Runs a command and writes down its resident memory as it goes.

    python -I -S resident_memory.py REPORT SECONDS COMMAND...

REPORT gets a number of bytes on each line, EVERY seconds apart; exit status and messages are the command's,
and one that does not end within SECONDS is killed.
"""

import os
import subprocess
import sys
import time

EVERY = 0.2
report, seconds, *command = sys.argv[1:]
end = time.monotonic() + float(seconds)
page = os.sysconf("SC_PAGE_SIZE")
with subprocess.Popen(command) as process, open(report, "w") as file:  # noqa: PTH123 pathlib is slow to import
    while process.poll() is None:
        if time.monotonic() > end:
            process.kill()
            sys.exit(f"the solver did not end within {seconds} s")
        with open(f"/proc/{process.pid}/statm") as now:  # noqa: PTH123
            fields = now.read().split()
        file.write(f"{int(fields[1]) * page if len(fields) > 1 else 0}\n")
        try:
            process.wait(EVERY)
        except subprocess.TimeoutExpired:
            continue
sys.exit(process.returncode)
