"""Five hundred things in a row, by seed, on people, with jobs: no exception, no stuck job, little memory, nothing lost.

Run on a screen: xvfb-run -a -s "-screen 0 1440x900x24" python tests/benchmarks/soak.py [--seed N] [--quick]
Ends with status 1 if anything of that fails. Not part of `make bench`: it takes several minutes.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from dataclasses import fields
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "viewer"))

MOST_GROWTH = 100.0
"""Megabytes between a fifth of the actions, when every library is loaded and every view there, and the end."""
PEOPLE = ["humans/0", "humans/1", "humans/12", "dogs/3", "dogs/4"]


def main() -> int:
    """Print what happened."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--actions", type=int, default=500)
    parser.add_argument("--quick", action="store_true", help="small shapes, no jobs")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="soak-"))
    os.environ["ADD_DATA_DIR"] = str(folder / "data")
    from PySide6.QtCore import QSettings
    from soaking import Soaker, small_shapes

    from add_viewer.assembly import Assembly

    def started() -> Assembly:
        store = QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)
        assembly = Assembly([], store=store, size=(1440, 900), theme="light")
        assembly.show()
        assembly.window.activateWindow()
        return assembly

    assembly = started()
    references = small_shapes(folder) + ([] if options.quick else PEOPLE)
    soaker = Soaker(assembly, options.seed, references, folder, thorough=not options.quick)
    begun = time.perf_counter()
    soaker.act(options.actions // 5)
    soaker.use_every_view()
    soaker.settle()
    early = soaker.memory()
    for part in range(4):
        soaker.act(options.actions // 5)
        print(f"{(part + 2) * options.actions // 5} actions after {time.perf_counter() - begun:.0f} s", flush=True)
    faults = [*soaker.problems]
    if not soaker.settle():
        faults.append("something never ended")
    kept, path = soaker.kept(), folder / "end.addsession"
    assembly.keeping.save(path)
    growth = soaker.memory() - early
    if growth > MOST_GROWTH:
        faults.append(f"memory grew by {growth:.0f} MB")
    assembly.stop()
    again = started()
    later = Soaker(again, 0, references, folder, thorough=False)
    again.keeping.open(path)
    later.settle()
    back = later.kept()
    differing = [each.name for each in fields(kept) if getattr(kept, each.name) != getattr(back, each.name)]
    if differing:
        faults.append(f"the session did not come back as it was: {', '.join(differing)} differ")
    again.stop()
    print(
        f"{len(soaker.done)} actions, seed {options.seed}, {time.perf_counter() - begun:.0f} s; memory +{growth:.0f} MB"
    )
    print("\n".join(faults) or "no exception, no stuck job, session restored identically")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
