"""Runs a command from a process as small as Python gets and writes down how much memory the command took.

    python -I -S peak_memory.py REPORT SECONDS COMMAND...

A process starts as a copy of the one that starts it and inherits its peak, so that measured from a large
Python every small solver run would look large. REPORT gets the peak resident memory in bytes; the exit status
and the messages are the command's, and one that does not end within SECONDS is killed.
"""

import resource
import subprocess
import sys

report, seconds, *command = sys.argv[1:]
try:
    status = subprocess.run(command, timeout=float(seconds), check=False).returncode
except subprocess.TimeoutExpired:
    sys.exit(f"the solver did not end within {seconds} s")
with open(report, "w") as file:  # noqa: PTH123 pathlib would make this process larger
    file.write(str(1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss))  # Linux counts in KiB
sys.exit(status)
