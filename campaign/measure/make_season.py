"""Makes a season of simulated recordings, short ones, some of them bad: to try a campaign, and to measure one.

    python campaign/measure/make_season.py --host-sim host-sim --recordings 200 --bad 3 SEASON

Three bodies on four days. The second has a steel screw more from the third day on; of the third every other tow has a lag.
"""

import argparse
import csv
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

DAYS = ("2026-06-20", "2026-06-21", "2026-06-24", "2026-06-25")
BODIES = ("anna", "berta", "clara")
# Permanent (nT), induced (nT/nT) and eddy (s) terms, about as large as those of the published lake.
COEFFICIENTS = (
    *(-210.0, 135.0, -600.0),
    *(0.002, 0.0015, -0.001, 0.003, 0.0005, -0.002),
    *(0.001, 0.0009, -0.006, -0.004, 0.001, -0.0001, 0.001, 0.0007, -0.002),
)
SCREW_NT = 80.0
SCENARIO = """title = "A short recording"
seed = 1
duration_s = {seconds}

[field]
latitude_deg = 39.1
longitude_deg = 121.8
date = "{day}"
time = "08:30:00"
strength_nT = 52379.0

[background]
geology_rms_nT = 8.0
geology_shortest_period_s = 60.0
diurnal_nT_per_h = 5.0

{motion}

[interference]
coefficients = [{coefficients}]

[scalar]
noise_rms_nT = 0.03
resolution_nT = 0.001

[fluxgate]
noise_rms_nT = 0.5
resolution_nT = 0.01

[columns]
attitude = true
line = true
{more}"""
# What a tow has and a calibration on land has not: depth, a place, and a piece of iron that is passed.
AFLOAT = """depth = true
position = true
altitude = true
speed = true
utc = true

[bottom]
depth_m = 7.0

[[dipole]]
moment_Am2 = 6.0
inclination_deg = 20.0
declination_deg = 70.0
at_s = 55.0
offset_m = 1.5
below_m = 3.2
"""
LAKE = """[motion]
kind = "lake_tow"
shortest_period_s = 2.5
longest_period_s = 16.0
depth_rms_m = 0.2
speed_m_per_s = 2.0

[motion.tow]
first_heading_deg = 35.0
leg_s = 40.0
turn_s = 15.0
turn_deg = 90.0
roll_rms_deg = 2.5
pitch_rms_deg = 1.5
yaw_rms_deg = 2.0
depth_m = 4.0"""
LAND = """[motion]
kind = "land_calibration"
headings = 4
leg_s = 30.0
turn_s = 10.0
roll_rms_deg = 12.0
pitch_rms_deg = 10.0
yaw_rms_deg = 12.0
rocking_period_s = 6.5
shake_rms_deg = 1.0
shake_s = 5.0"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("season", type=Path)
    parser.add_argument("--host-sim", default="host-sim")
    parser.add_argument("--recordings", type=int, default=200, help="bad ones too")
    parser.add_argument("--bad", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=150.0)
    told = parser.parse_args()
    (told.season / "raw").mkdir(parents=True, exist_ok=True)
    rows = [{"name": f"{body}-cal", "body": body, "day": DAYS[0], "kind": "calibration"} for body in BODIES]
    for number in range(told.recordings - len(BODIES)):
        body, day = BODIES[number % len(BODIES)], DAYS[number // len(BODIES) % len(DAYS)]
        rows.append({"name": f"{body}-{number:04}", "body": body, "day": day, "kind": "tow"})
    # Spread over the tows, none of them a calibration.
    tows = len(rows) - len(BODIES)
    bad = {len(BODIES) + tows * (2 * number + 1) // (2 * told.bad): number for number in range(told.bad)}
    with ThreadPoolExecutor() as pool:
        list(pool.map(lambda number: make(told, rows[number], number, bad.get(number)), range(len(rows))))
    with (told.season / "season.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("name", "body", "day", "kind", "file"), lineterminator="\n")
        writer.writeheader()
        writer.writerows(row | {"file": f"raw/{row['name']}.csv"} for row in rows)


def make(told: argparse.Namespace, row: dict, number: int, bad: int | None) -> None:
    """A recording, or what is none: by turns another file, one that is too short, and none at all."""
    path = told.season / "raw" / f"{row['name']}.csv"
    kind = None if bad is None else bad % 3
    if kind == 0:
        path.write_text("This is the protocol of the 24th.\nWind 5, sea 3, nothing was recorded.\n")
    if kind in (0, 2):
        return
    coefficients = list(COEFFICIENTS)
    if row["body"] == "berta" and row["day"] >= DAYS[2]:
        coefficients[0] += SCREW_NT
    scenario = path.with_suffix(".toml")
    seconds = 20.0 if kind == 1 else told.seconds
    motion, more = (LAND, "") if row["kind"] == "calibration" else (LAKE, AFLOAT)
    numbers = ", ".join(map(str, coefficients))
    text = SCENARIO.format(seconds=seconds, day=row["day"], motion=motion, more=more, coefficients=numbers)
    scenario.write_text(text)
    has_lag = row["body"] == "clara" and row["kind"] == "tow" and number % 2
    lag = ["--effect", "scalar_lag:lag_s=0.08"] if has_lag else []
    command = [told.host_sim, "simulate", scenario, "--quiet", "--seed", str(1000 + number), *lag, "--out", path]
    subprocess.run(command, check=True)
    scenario.unlink()


if __name__ == "__main__":
    main()
