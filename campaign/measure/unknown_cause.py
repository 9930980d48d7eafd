"""Whether a campaign finds a cause that comes again and that no effect of the library explains.

    python campaign/measure/unknown_cause.py FOLDER --host-sim host-sim

Eighteen simulated tows of ten minutes with a pump whose current is recorded. On seven of them it disturbs the field by a law that is not
in the library, on five others the field has a vertical gradient, which the diagnosis is not allowed to know; six have neither. What
the campaign says is held against that, and what it proposes against three tows that it has not seen.
"""

import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
SNAKEFILE = HERE.parent / "Snakefile"
SCENARIO = HERE.parent.parent / "scenarios/lake_tow.toml"
PUMP = """
[[current]]
name = "pump"
on_A = 2.0
period_s = 47.0
duty = 0.4
"""
# A moment along the body's axis that follows the current as a low-pass does: docs/effect_files.md.
EFFECT = """name = "pump_moment"
channel = "scalar"
kind = "additive"
formula = "3.0 * warm_A * cx"

[inputs.warm_A]
of = "current_pump_A"
filter = "lowpass"
time_s = 4.0
"""
GRADIENT = ["--effect", "depth_gradient:gradient_nT_per_m=0.6"]
# Both follow the depth: with neither, what follows it has no name.
WITHHELD = ["--withhold", "depth_gradient", "--withhold", "swell_induction"]
CAUSES = {"pump": 7, "depth": 5, "none": 6}
DRIVERS = {"pump": "current_pump_A", "depth": "depth"}
SEED = 601


def simulated(told: argparse.Namespace, name: str, cause: str, seed: int) -> Path:
    """A recording with this cause in it."""
    path = told.folder / "raw" / f"{name}.csv"
    effects = {"pump": ["--effect-file", told.folder / "pump_moment.toml"], "depth": GRADIENT, "none": []}[cause]
    command = [told.host_sim, "simulate", told.folder / "tow.toml", "--quiet", "--seed", str(seed), *effects, "--out", path]
    subprocess.run(command, check=True)
    return path


def season(told: argparse.Namespace) -> dict[str, list[str]]:
    """The recordings with each cause, by name; causes take turns as far as they go."""
    shutil.rmtree(told.folder, ignore_errors=True)
    (told.folder / "raw").mkdir(parents=True)
    (told.folder / "pump_moment.toml").write_text(EFFECT)
    text = SCENARIO.read_text(encoding="utf-8")
    for old, new in {"duration_s = 1200.0": "duration_s = 600.0", "leg_s = 200.0": "leg_s = 100.0", "turn_s = 60.0": "turn_s = 30.0"}.items():
        assert old in text, f"{SCENARIO} has no {old}"
        text = text.replace(old, new)
    (told.folder / "tow.toml").write_text(text + PUMP)
    turns = [cause for turn in range(max(CAUSES.values())) for cause, count in CAUSES.items() if turn < count]
    names: dict[str, list[str]] = {cause: [] for cause in CAUSES}
    lines = ["name,body,day,kind,file"]
    for number, cause in enumerate(turns):
        name = f"tow-{number:02}"
        simulated(told, name, cause, SEED + number)
        names[cause].append(name)
        lines.append(f"{name},anna,2026-06-{10 + number},tow,raw/{name}.csv")
    (told.folder / "season.csv").write_text("\n".join(lines) + "\n")
    options = json.dumps({"diagnose": WITHHELD})
    (told.folder / "config.yaml").write_text(f"host_sim: {told.host_sim}\npages: false\noptions: {options}\n")
    return names


def named(told: argparse.Namespace, cause: str, number: int) -> list[str]:
    """What a diagnosis names on a tow that nobody has seen, with all effects that were proposed."""
    recording = simulated(told, f"next-{number}", cause, SEED + 100 + number)
    out = told.folder / "next" / str(number)
    files = [word for path in sorted((told.folder / "unknowns").glob("*.toml")) for word in ("--effect-file", path)]
    subprocess.run([told.host_sim, "diagnose", "--quiet", recording, *WITHHELD, *files, "--out", out], check=True)
    return [effect["name"] for effect in json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))["effects"]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--host-sim", default="host-sim")
    told = parser.parse_args()
    program = shutil.which(told.host_sim) or sys.exit(f"{told.host_sim}: is not there: name it with --host-sim")
    told.host_sim, told.folder = str(Path(program).resolve()), told.folder.resolve()
    names = season(told)
    engine = [sys.executable, "-m", "snakemake", "--snakefile", str(SNAKEFILE), "--directory", str(told.folder), "--quiet", "all", "--cores", "2"]
    subprocess.run(engine, check=True)
    clusters = {one["driver"]: one for one in json.loads((told.folder / "unknowns/unknowns.json").read_text(encoding="utf-8"))["clusters"]}
    for cause, driver in DRIVERS.items():
        found = clusters.pop(driver, {"members": [], "seen_on": [], "text": "no cluster"})
        for what in ("members", "seen_on"):
            missed, wrong = set(names[cause]) - set(found[what]), set(found[what]) - set(names[cause])
            print(f"{cause}: {what}: {len(names[cause]) - len(missed)} of {len(names[cause])}, {len(wrong)} wrong")
        print(f"{cause}: {found['text']}")
    print(f"other clusters: {[one['text'] for one in clusters.values()]}")
    for number, cause in enumerate(CAUSES):
        print(f"a tow of the next season with {cause}: {named(told, cause, number)}")


if __name__ == "__main__":
    main()
