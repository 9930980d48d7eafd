"""How well the course that `diagnose` recovers goes with a current that it was not given.

    python trial/baselines/recovered_course.py target/release/host-sim data/sgl_line_2004

The folder holds one flight twice: `flux_b_mag_2_current_hidden.csv` and, with the current of the strobe light, `flux_b_mag_2_with_current.csv`
(SGL 2021 magnetic navigation data, which may not be redistributed). Both are diagnosed; printed are the drivers that come first of the one
without the current, and the correlation of the column `driver` of its gap.csv with the current, both from 0.05 to 4 Hz: row by row, and with
the current moved by the delay that the diagnosis with it tells.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

RATE_HZ = 10.0
BAND_HZ = (0.05, 4.0)


def band_passed(values):
    """Without phase, by the spectrum."""
    spectrum = np.fft.rfft(values - values.mean())
    hz = np.fft.rfftfreq(len(values), 1.0 / RATE_HZ)
    return np.fft.irfft(np.where((hz >= BAND_HZ[0]) & (hz <= BAND_HZ[1]), spectrum, 0.0), len(values))


def columns(file):
    return np.genfromtxt(file, delimiter=",", names=True, deletechars="")


def diagnosed(program, recording):
    """The diagnosis, and the recovered course at its times."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "diagnose", recording, "--out", folder], check=True, stdout=subprocess.DEVNULL)
        return json.loads((Path(folder) / "diagnosis.json").read_text()), columns(Path(folder) / "gap.csv")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="host-sim")
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    said, gap = diagnosed(options.program, options.folder / "flux_b_mag_2_current_hidden.csv")
    with_current = options.folder / "flux_b_mag_2_with_current.csv"
    told, _ = diagnosed(options.program, with_current)
    whole = columns(with_current)
    [current] = [name for name in whole.dtype.names if name.startswith("current_")]
    # The course has no value where rows are not used: straight lines across.
    known = np.isfinite(gap["driver"])
    course = np.interp(whole["time_s"], gap["time_s"][known], gap["driver"][known])
    [delay_s] = [effect["column"]["delay_s"] for effect in told["effects"] if effect.get("column")]
    moved = np.interp(whole["time_s"] - delay_s, whole["time_s"], whole[current])
    for driver in said["unexplained"]["drivers"][:3]:
        print(f"{driver['input']}: {driver['probability']:.2f}")
    for column, how in ((whole[current], "row by row"), (moved, f"{delay_s:+.2f} s later")):
        correlation = np.corrcoef(band_passed(course), band_passed(column))[0, 1]
        print(f"correlation of the recovered course with {current}, {how}: {abs(correlation):.2f}")


if __name__ == "__main__":
    main()
