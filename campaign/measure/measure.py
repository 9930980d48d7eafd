"""What a campaign costs, and whether it comes to the same bytes however it was run.

    python campaign/measure/measure.py season FOLDER --host-sim host-sim        # 200 recordings, 3 bad, 20 kills
    python campaign/measure/measure.py trial FOLDER --host-sim host-sim         # 1,000 recordings in 8 shards

`--slurm` runs the season on the Slurm of this machine too (one_node_slurm.sh). Needs what requirements.txt names, on Linux.
"""

import argparse
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
SNAKEFILE = HERE.parent / "Snakefile"
SUMMARY = ("contacts.csv", "coefficients.csv", "index.html", "recordings.csv", "summary.json")
SLURM = (
    *("--profile", str(HERE.parent / "profiles/slurm"), "--slurm-status-command", "squeue", "--slurm-no-account"),
    *("--slurm-init-seconds-before-status-checks", "5", "--seconds-between-status-checks", "5"),
)


def engine(folder: Path, *arguments: str) -> list[str]:
    common = ("--quiet", "all")
    return [sys.executable, "-m", "snakemake", "--snakefile", str(SNAKEFILE), "--directory", str(folder), *common, *arguments]


def run(*commands: list[str], **environment: str) -> tuple[float, float]:
    """Side by side: seconds of the clock and of the processor."""
    def used() -> float:
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    begin, before = time.monotonic(), used()
    started = [
        subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=os.environ | environment)
        for command in commands
    ]
    for process in started:
        said = process.communicate()[1]
        if process.returncode:
            sys.exit(f"{' '.join(process.args)}: exit code {process.returncode}\n{said.decode()[-3000:]}")
    return time.monotonic() - begin, used() - before


def logs(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder / "logs").with_suffix("")): path.read_text() for path in folder.glob("logs/*/*.log")}


def begun(folder: Path) -> dict[str, int]:
    return {step: text.count("started: ") for step, text in logs(folder).items()}


def of_steps(folder: Path) -> float:
    """Seconds of the processor of host-sim alone."""
    return sum(float(cost) for text in logs(folder).values() for cost in re.findall(r", ([\d.]+) s of processor", text))


def done(folder: Path) -> set[str]:
    """Steps with an outcome."""
    return {str(path.relative_to(folder / "outcomes").with_suffix("")) for path in folder.glob("outcomes/*/*.json")}


def variant(told: argparse.Namespace, name: str) -> Path:
    """A campaign of its own on the same recordings."""
    folder = told.folder / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "raw").symlink_to(told.folder.resolve() / "season" / "raw")
    shutil.copy(told.folder / "season" / "season.csv", folder)
    (folder / "config.yaml").write_text(f"host_sim: {told.host_sim}\npages: false\n")
    return folder


def same(one: Path, other: Path) -> str:
    names = [name for name in SUMMARY if (one / "summary" / name).read_bytes() != (other / "summary" / name).read_bytes()]
    return f"other bytes in {', '.join(names)}" if names else "the same bytes"


def season(told: argparse.Namespace) -> None:
    command = [sys.executable, HERE / "make_season.py", "--host-sim", told.host_sim, told.folder / "season"]
    options = ["--recordings", str(told.recordings), "--bad", "3", "--seconds", str(told.seconds)]
    subprocess.run([*command, *options], check=True)
    whole = variant(told, "whole")
    wall_s, processor_s = run(engine(whole, "--cores", "2"))
    steps_s, steps = of_steps(whole), len(begun(whole))
    print(f"--cores 2: {wall_s:.0f} s, {processor_s:.0f} s of processor, host-sim {steps_s:.0f} s of it; {steps} steps, "
          f"the engine {(processor_s - steps_s) / steps * 1000:.0f} ms a step", flush=True)
    again_s, _ = run(engine(whole, "--cores", "2"))
    print(f"again, nothing to do: {again_s:.1f} s", flush=True)

    killed(told, whole, wall_s)

    halves = variant(told, "halves")
    # Two engines may not be about to make the same file, so what both halves need comes first.
    first, *both = targets(whole)
    first_s, _ = run(engine(halves, "--cores", "1", "--", *first))
    wall_s, _ = run(*(engine(halves, "--cores", "1", "--", *half) for half in both))
    rest_s, _ = run(engine(halves, "--cores", "1"))
    print(f"two terminals of --cores 1: {first_s:.0f} s for the calibrations, {wall_s:.0f} s, {rest_s:.0f} s for the rest: {same(whole, halves)}, "
          f"begun twice: {sum(times > 1 for times in begun(halves).values())}", flush=True)
    if told.slurm:
        slurm = variant(told, "slurm")
        wall_s, _ = run([*engine(slurm), *SLURM])
        print(f"Slurm, one node: {wall_s:.0f} s: {same(whole, slurm)}", flush=True)


def targets(whole: Path) -> tuple[list[str], list[str], list[str]]:
    """Outcomes of the calibrations, and of the tows by halves."""
    paths = sorted(str(path.relative_to(whole)) for path in whole.glob("outcomes/*/*.json"))
    tows = [path for path in paths if "-cal/" not in path]
    return [path for path in paths if "-cal/" in path], tows[: len(tows) // 6 * 3], tows[len(tows) // 6 * 3 :]


def killed(told: argparse.Namespace, whole: Path, wall_s: float) -> None:
    """The engine and all that it started, at random moments, as by a power cut."""
    folder, chance = variant(told, "killed"), random.Random(18)
    kills, finished, again = 0, 0, 0
    for _ in range(told.kills):
        done_before, begun_before = done(folder), begun(folder)
        process = subprocess.Popen(
            engine(folder, "--cores", "2"), start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        try:
            process.wait(chance.uniform(0, 2 * wall_s / told.kills))
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
        run(engine(folder, "--unlock", "--cores", "1"))
        finished += redone(folder, done_before, begun_before)
    done_before, begun_before = done(folder), begun(folder)
    run(engine(folder, "--cores", "2"))
    finished += redone(folder, done_before, begun_before)
    counts = begun(folder).values()
    again = sum(counts) - len(counts)
    print(f"killed {kills} times: {same(whole, folder)}; of {len(counts)} steps {again} were cut and begun again, where two cores "
          f"can have been at work at {2 * kills}; {finished} of them had left an outcome that the engine had not yet seen", flush=True)


def redone(folder: Path, done_before: set[str], begun_before: dict[str, int]) -> int:
    """Steps that had been done, and were begun again since."""
    now = begun(folder)
    return sum(now[step] > begun_before[step] for step in done_before if step in begun_before)


def trial(told: argparse.Namespace) -> None:
    folder = told.folder / "trial"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    options = ["--minutes", str(told.minutes)]
    (folder / "config.yaml").write_text(
        f"season: ''\nhost_sim: {told.host_sim}\n"
        f"trial: {{seeds: [1], recordings: {told.recordings}, shards: {told.shards}, options: {options}}}\n"
    )
    alone = [told.host_sim, "trial", "--quiet", "--seed", "1", "--recordings", str(told.recordings), *options]
    # On as many cores as the engine: two threads of one core are slower, each, than one that has it for itself.
    _, alone_s = run([*alone, "--out", str(folder / "alone")], RAYON_NUM_THREADS="2")
    wall_s, processor_s = run(engine(folder, "--cores", "2"))
    files = ("trial.json", "answers.json", "report.html")
    other = [name for name in files if (folder / "alone" / name).read_bytes() != (folder / "trial/1/whole" / name).read_bytes()]
    print(f"{told.recordings} recordings of {told.minutes:g} min: at once {alone_s:.0f} s of processor; in {told.shards} shards "
          f"{processor_s:.0f} s, {wall_s:.0f} s of the clock: {'other bytes in ' + ', '.join(other) if other else 'the same bytes'}; "
          f"engine and merge {(processor_s - alone_s) / alone_s * 100:.1f} %", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("season", "trial"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--host-sim", default="host-sim")
    parser.add_argument("--recordings", type=int)
    parser.add_argument("--seconds", type=float, default=90.0, help="of a recording of the season")
    parser.add_argument("--minutes", type=float, default=2.0, help="of a recording of the trial")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--shards", type=int, default=8)
    parser.add_argument("--slurm", action="store_true")
    told = parser.parse_args()
    told.host_sim = shutil.which(told.host_sim) or sys.exit(f"{told.host_sim}: is not there: name it with --host-sim")
    told.host_sim = str(Path(told.host_sim).resolve())
    told.recordings = told.recordings or {"season": 200, "trial": 1000}[told.what]
    season(told) if told.what == "season" else trial(told)


if __name__ == "__main__":
    main()
