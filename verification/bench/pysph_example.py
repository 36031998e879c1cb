"""Runs one of PySPH's own examples unchanged, with the system's Python that has PySPH; called by peers.py.

    python3 pysph_example.py EXAMPLE APPLICATION OPTIONS...

The example measures its own errors while it draws its pictures. Debian's PySPH does not bring matplotlib, and
nobody looks at these pictures: a stand-in takes the drawing calls, and the errors are written as ever
(results.npz). Its last particles go to final.npz as well, for our comparer.
"""

import importlib
import sys
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np

for name in ("matplotlib", "matplotlib.pyplot"):
    sys.modules[name] = MagicMock()

from pysph.solver.utils import load  # noqa: E402 after the stand-ins

example, application_name, *options = sys.argv[1:]
application = getattr(importlib.import_module(f"pysph.examples.{example}"), application_name)(fname=example)
application.run(options)
application.post_process(application.info_filename)
data = load(application.output_files[-1])
fluid, state = data["arrays"]["fluid"], data["solver_data"]
columns = {name: fluid.get(name, only_real_particles=True) for name in ("x", "y", "u", "v")}
np.savez(Path(application.output_dir) / "final.npz", t=state["t"], steps=state["count"], **columns)
