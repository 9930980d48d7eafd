# %% [markdown]
# # From a recording to what is in it
#
# Cells as Jupyter, VS Code and Spyder know them; as a script:
#
#     pip install -r examples/python/requirements.txt
#     python examples/python/towmag_notebook.py --out out          # the sample
#     python examples/python/towmag_notebook.py cal.csv tow.csv    # your own
#
# Every field that is read here is described in docs/results.md.

# %%
import argparse
import json
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd

try:
    ROOT = Path(__file__).resolve().parents[2]
except NameError:  # in a notebook
    ROOT = Path.cwd()

parser = argparse.ArgumentParser(description="Calibrates, compensates, diagnoses and draws a recording.")
parser.add_argument("calibration", nargs="?", type=Path, default=ROOT / "sample/calibration.csv")
parser.add_argument("recording", nargs="?", type=Path, default=ROOT / "sample/survey.csv")
parser.add_argument("--out", type=Path, default=Path("out"), help="folder for all results")
parser.add_argument("--host-sim", default="host-sim", help="the program, if it is not on the path")
options, _of_the_notebook = parser.parse_known_args()
for file in (options.calibration, options.recording):
    if not file.is_file():
        raise SystemExit(f"{file}: no such file")
options.out.mkdir(parents=True, exist_ok=True)


def host_sim(*arguments):
    """Run a command; its own one line says what was wrong."""
    command = [options.host_sim, *map(str, arguments)]
    try:
        done = subprocess.run(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    except FileNotFoundError:
        raise SystemExit(f"{options.host_sim} is not there: `cargo install --path host-sim`, or say --host-sim PATH") from None
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr.strip()}")


# %% [markdown]
# ## Import
#
# What is a recording already is taken as it is: a CSV with these five columns. Anything else goes through `host-sim import`,
# which says beside it (`*.import.json`) what it took for what. Read that before you trust what follows.

# %%
REQUIRED = {"time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"}


def is_recording(file):
    """Whether host-sim reads a file as it is: our CSV, or the log of a body."""
    with open(file, "rb") as source:
        first = source.readline(10_000)
    columns = first.decode("utf-8-sig", "replace").strip().split(",")
    return first.startswith((b"TMLS", b"TOWMAGLF")) or REQUIRED <= set(columns)


def imported(file):
    if is_recording(file):
        return file
    recording = options.out / f"{file.stem}.csv"
    host_sim("import", file, "--out", recording)
    said = json.loads(recording.with_suffix(".import.json").read_text(encoding="utf-8"))
    for finding in said["findings"]:
        print(f"{file.name}: {finding['text']}")
    return recording


calibration, recording = imported(options.calibration), imported(options.recording)

# %% [markdown]
# ## Calibrate, compensate, diagnose

# %%
coefficients = options.out / "calibrated/coefficients.toml"
host_sim("calibrate", calibration, "--out", options.out / "calibrated")
host_sim("replay", recording, "--coefficients", coefficients, "--out", options.out / "compensated")
host_sim("diagnose", recording, "--coefficients", coefficients, "--out", options.out / "gap")

compensated = pd.read_csv(options.out / "compensated/compensated.csv")
gap = pd.read_csv(options.out / "gap/gap.csv")
summary = json.loads((options.out / "compensated/summary.json").read_text(encoding="utf-8"))
diagnosis = json.loads((options.out / "gap/diagnosis.json").read_text(encoding="utf-8"))

# %% [markdown]
# ## The answer
#
# In the band of 0.1 to 0.9 Hz, strictly predictive: no row is compensated with coefficients that have seen it.

# %%
# A ratio is null where nothing is left.
ratio = f", {summary['improvement_ratio']:.1f} times less" if summary["improvement_ratio"] else ""
answer = (
    f"Compensated: {summary['std_before_nT']:.2f} nT before, {summary['std_after_nT']:.2f} nT after{ratio} "
    f"({summary['method']}, {summary['used_rows']} of {summary['rows']} rows)"
)
print(answer)
print(f"Diagnosis: {diagnosis['summary']}")
for effect in diagnosis["effects"]:
    low, high = effect["gap_closed"]["ci95"]
    print(f"  {effect['name']}: probability {effect['probability']:.2f}, closes {low:.0%} to {high:.0%} of the gap")

targets = pd.DataFrame(diagnosis["targets"], columns=["time_s", "peak_nT", "width_s", "probability"])
if targets.empty:
    print("No target.")
else:
    table = targets.round({"time_s": 1, "peak_nT": 2, "width_s": 1, "probability": 3})
    print(table.rename(columns={"time_s": "time (s)", "peak_nT": "peak (nT)", "width_s": "width (s)"}).to_string(index=False))

# %% [markdown]
# ## Field, compensated field, residual
#
# A row that is not valid is a hole in the line: nothing is drawn across it. The levels are arbitrary, so each curve stands around its own median.

# %%
BEFORE, AFTER, TARGET = "#5f5f5f", "#0b5394", "#b34700"
plt.rcParams.update({"font.size": 11, "axes.grid": True, "grid.alpha": 0.25, "axes.spines.top": False, "axes.spines.right": False})

valid = compensated["valid"] == 1
# The filter and the coefficients take their time at the start: that shall not set the scale.
settled = valid & (compensated["adaptation"] != "waiting")
first_s = compensated["time_s"].iloc[0]


def since_start(time_s):
    """Minutes, whatever the origin of the recording's clock."""
    return (time_s - first_s) / 60


def drawn(axes, table, column, keep, color, label, width=0.9):
    """A column over time, nothing where a row is not valid nor across a gap in time."""
    values = table[column].where(keep)
    values = values.mask(table["time_s"].diff() > 0.15)
    axes.plot(since_start(table["time_s"]), values, color=color, linewidth=width, label=label)


def scaled(axes, values):
    """A scale of what is usual and of the targets, with room, and a word where something lies beyond."""
    low, high = values.where(settled).quantile([0.02, 0.98])
    for target in targets.itertuples():
        near = values[(compensated["time_s"] - target.time_s).abs() < 2 * target.width_s]
        low, high = min(low, near.min()), max(high, near.max())
    room = 0.5 * (high - low)
    axes.set_ylim(low - room, high + room)
    least, most = values.where(valid).min(), values.where(valid).max()
    if least < low - room or most > high + room:
        text = f"beyond the scale: {least:,.0f} to {most:,.0f} nT"
        axes.annotate(text, (1, 0), xycoords="axes fraction", ha="right", va="bottom", color=TARGET, fontsize=9)


def heading(axes, text, unit):
    axes.set_title(text, loc="left", fontsize=11, fontweight="bold")
    axes.set_ylabel(unit)


where = pd.DataFrame(diagnosis["where"])
bands = where[where["by"] == "band"] if len(where) else where
has_gap = diagnosis["verdict"] != "no_gap" and len(bands) > 0

figure, (field_axes, compensated_axes, residual_axes, gap_axes) = plt.subplots(
    4, 1, figsize=(11, 13 if has_gap else 10.5), height_ratios=[1, 1, 1, 1 if has_gap else 0.15], layout="constrained"
)
figure.suptitle(f"{recording.name}\n{answer}\n{diagnosis['summary']}", x=0.01, ha="left", fontsize=12, wrap=True)

level = compensated["scalar_nT"].where(valid).median()
about = compensated.assign(
    scalar_nT=compensated["scalar_nT"] - level,
    compensated_nT=compensated["compensated_nT"] - compensated["compensated_nT"].where(valid).median(),
)
drawn(field_axes, about, "scalar_nT", valid, BEFORE, "as read")
drawn(compensated_axes, about, "compensated_nT", valid, AFTER, "compensated")
heading(field_axes, f"Scalar as read, around {level:,.0f} nT", "nT")
heading(compensated_axes, "Compensated, around its median: look for targets here", "nT")

drawn(residual_axes, compensated, "residual_nT", valid, AFTER, "residual")
if compensated["predicted_std_nT"].notna().any():
    usual = 2 * compensated["predicted_std_nT"].where(settled)
    residual_axes.fill_between(
        since_start(compensated["time_s"]), -usual, usual, color=AFTER, alpha=0.2, linewidth=0, label="95 % as predicted, without targets"
    )
    residual_axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, borderaxespad=0)
heading(residual_axes, "Residual, 0.1 to 0.9 Hz", "nT")
scaled(compensated_axes, about["compensated_nT"])
scaled(residual_axes, compensated["residual_nT"])

for axes in (field_axes, compensated_axes, residual_axes):
    axes.set_xlim(0, since_start(compensated["time_s"].iloc[-1]))
    axes.xaxis.get_major_locator().set_params(integer=True)
residual_axes.set_xlabel("minutes since the start")
for number, target in enumerate(targets.itertuples(), start=1):
    for axes in (compensated_axes, residual_axes):
        axes.axvline(since_start(target.time_s), color=TARGET, linewidth=1, linestyle="--")
    compensated_axes.annotate(
        f" {number}: {target.peak_nT:+.1f} nT", (since_start(target.time_s), 1), xycoords=("data", "axes fraction"), va="top", color=TARGET
    )

# %% [markdown]
# ## Where the gap lies
#
# Each bar is the share of all that stands above the noise, of both sensors: long bars say where to look. Without a gap there is nothing to share out.

# %%
if not has_gap:
    gap_axes.axis("off")
    gap_axes.text(0, 0, "No gap: nothing above the noise to share out by band.", fontsize=11)
else:
    shares = bands.pivot(index="cell", columns="channel", values="excess_share")
    shares = shares.loc[sorted(shares.index, key=lambda cell: float(cell.split("-")[0]))]
    shares = 100 * shares[[channel for channel in ("scalar", "fluxgate") if channel in shares]]
    shares.plot.barh(ax=gap_axes, color=[AFTER, "#8fb8de"], width=0.8)
    heading(gap_axes, "Where the gap lies, by band: share of what is above the noise", "")
    gap_axes.set_xlabel("% of the gap")
    gap_axes.legend(loc="lower right", frameon=False)
    gap_axes.grid(axis="y", visible=False)
    for bars in gap_axes.containers:
        gap_axes.bar_label(bars, labels=[f"{share:.0f} %" if share >= 1 else "" for share in bars.datavalues], padding=3, fontsize=9)

picture = options.out / "picture.png"
figure.savefig(picture, dpi=120)
print(f"Drawn: {picture}")

# %% [markdown]
# ## The residual of the diagnosis, at its full rate
#
# Before and after the effects that are named, with their root mean squares over the same rows.

# %%
for channel in ("scalar", "fluxgate"):
    columns = [f"{channel}_before_nT", f"{channel}_after_nT"]
    if set(columns) <= set(gap):
        before, after = (gap[columns].dropna() ** 2).mean() ** 0.5
        print(f"{channel}: residual {before:.3f} nT rms, {after:.3f} nT with the effects named")
