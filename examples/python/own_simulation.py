# %% [markdown]
# # A recording held against a simulation of your own
#
# Cells as Jupyter, VS Code and Spyder know them; as a script:
#
#     pip install -r examples/python/requirements.txt
#     python examples/python/own_simulation.py tow.csv --out out
#
# The simulation here is the smallest that is one: the Earth's field with a slow background, and a body with a permanent and an
# induced moment. Put your own in its place: whatever it knows, `host-sim diagnose --simulation` wants five columns of it, of the
# same track, at any rate and by any clock.

# %%
import argparse
import json
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd

try:
    ROOT = Path(__file__).resolve().parents[2]
except NameError:  # in a notebook
    ROOT = Path.cwd()

parser = argparse.ArgumentParser(description="Simulates the track of a recording and holds the recording against it.")
parser.add_argument("recording", nargs="?", type=Path, default=ROOT / "sample/survey.csv")
parser.add_argument("--out", type=Path, default=Path("out"), help="folder for all results")
parser.add_argument("--host-sim", default="host-sim", help="the program, if it is not on the path")
options, _of_the_notebook = parser.parse_known_args()
if not options.recording.is_file():
    raise SystemExit(f"{options.recording}: no such file")
options.out.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The track
#
# Attitude and field along the track, from the recording's own fluxgate: directions averaged over half a second, so that its noise
# is not the simulation's.

# %%
AXES = ["flux_x_nT", "flux_y_nT", "flux_z_nT"]
RATE_HZ = 25.0  # of the simulation: any will do
CLOCK_AHEAD_S = 3.21  # nor need its clock be the recording's

recording = pd.read_csv(options.recording)
valid = recording[["time_s", "scalar_nT", *AXES]].apply(pd.to_numeric, errors="coerce").notna().all(axis=1)
if "scalar_valid" in recording:
    valid &= recording["scalar_valid"] != 0
track = recording[valid]
times_s = np.arange(track["time_s"].iloc[0], track["time_s"].iloc[-1], 1.0 / RATE_HZ)


def simulated(values):
    """A column of the recording at the simulation's own times."""
    return np.interp(times_s, track["time_s"], values)


direction = np.column_stack([simulated(track[axis].rolling(5, center=True, min_periods=1).mean()) for axis in AXES])
direction /= np.linalg.norm(direction, axis=1, keepdims=True)
# The fluxgate's magnitude: the scalar sensor's has the body's own field in it, which changes with the heading.
magnitude_nt = pd.Series(np.linalg.norm(track[AXES].to_numpy(), axis=1))
field_nt = simulated(magnitude_nt.rolling(601, center=True, min_periods=1).mean())

# %% [markdown]
# ## The body
#
# A permanent moment (nT) and a symmetric induced one (nT per nT). With `--hold-terms` they would have to be right; without, the 18
# terms are fitted to the recording, and only what no such terms make is held against the simulation.

# %%
permanent_nt = np.array([12.0, -5.0, 8.0])
induced = 1e-4 * np.array([[2.0, 0.5, 0.0], [0.5, -1.0, 0.3], [0.0, 0.3, 1.5]])
along_nt = direction @ permanent_nt + field_nt * np.einsum("ri,ij,rj->r", direction, induced, direction)

# %% [markdown]
# ## Its readings

# %%
readings = {"time_s": times_s + CLOCK_AHEAD_S, "scalar_nT": field_nt + along_nt}
readings |= {name: field_nt * direction[:, axis] for axis, name in enumerate(AXES)}
simulation_file = options.out / "own_simulation.csv"
pd.DataFrame(readings).to_csv(simulation_file, index=False, float_format="%.5f")

# %% [markdown]
# ## Where and why they differ

# %%
command = [options.host_sim, "diagnose", options.recording, "--simulation", simulation_file, "--out", options.out / "gap"]
try:
    done = subprocess.run([str(part) for part in command], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
except FileNotFoundError:
    raise SystemExit(f"{options.host_sim} is not there: `cargo install --path host-sim`, or say --host-sim PATH") from None
if done.returncode:
    raise SystemExit(done.stderr.strip())
diagnosis = json.loads((options.out / "gap/diagnosis.json").read_text())
print(diagnosis["summary"])
print(f"The simulation's clock is {diagnosis['simulation']['offset_s']:.3f} s ahead of the recording's.")
for effect in diagnosis["effects"]:
    values = ", ".join(f"{parameter['name']} = {parameter['value']}" for parameter in effect["parameters"])
    print(f"{effect['name']}: probability {effect['probability']:.2f}, {values}")
