"""Runs one command of host-sim, and writes down what came of it.

A bad recording is an answer, not a failure: host-sim tells it by exit code 2, and it will be as bad the next time. So the
step is done, its outcome `refused`, and what follows is `left_out`; a campaign goes on, and is not held up again by what it
knows. Anything else (exit code 1, a signal) may go better the next time: the step fails, and the engine tries it again.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import whole

BAD_INPUT = 2
# Of a message, so that a page of a thousand recordings can be read.
LONGEST_MESSAGE = 500


def main() -> int:
    told = _arguments()
    refusal = _refusal(told.needs)
    if refusal:
        return _write(told, "left_out", refusal, None)
    command, without = list(told.command), None
    if told.coefficients:
        calibration, coefficients = told.coefficients
        without = _refusal([calibration])
        command += [] if without else ["--coefficients", coefficients]
    code, said = _run(command, told)
    if code == 0:
        lost = [result for result in told.results if not Path(result).is_file()]
        if lost:
            print(f"{told.outcome}: the command ended well, and {', '.join(lost)} is not there", file=sys.stderr)
            return 1
        return _write(told, "done", None, without)
    if code == BAD_INPUT:
        return _write(told, "refused", said, without)
    print(f"{' '.join(command)}: exit code {code}: {said}", file=sys.stderr)
    return 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("outcome", type=Path, help="where the outcome is written, after the results")
    parser.add_argument("--log", type=Path, required=True, help="what the command says is appended to it")
    parser.add_argument("--needs", nargs="*", default=[], help="outcomes that must be `done`")
    parser.add_argument("--coefficients", nargs=2, metavar=("OUTCOME", "FILE"), help="a calibration, if it was done")
    parser.add_argument("--results", nargs="+", required=True, help="files that the command leaves")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--without-pages", action="store_true", help="remove report.html: 5 MB a page")
    parser.add_argument("--command", nargs="+", required=True, help="all that follows, as it is")
    # By hand: a command has options of its own, and a `--` that argparse would take for one of ours.
    at = sys.argv.index("--command") if "--command" in sys.argv else len(sys.argv)
    told = parser.parse_args([*sys.argv[1:at], "--command", "as it is"])
    told.command = sys.argv[at + 1 :]
    if not told.command:
        parser.error("--command: names no command")
    return told


def _refusal(outcomes: list[str]) -> str | None:
    """Why something cannot be done, or must be done without one of these."""
    for path in outcomes:
        outcome = json.loads(Path(path).read_text(encoding="utf-8"))
        if outcome["outcome"] != "done":
            where = Path(path)
            return f"{where.stem} of {where.parent.name} was {outcome['outcome'].replace('_', ' ')}"
    return None


def _run(command: list[str], told: argparse.Namespace) -> tuple[int, str]:
    """The exit code, and the line of what was said that tells most."""
    told.log.parent.mkdir(parents=True, exist_ok=True)
    with told.log.open("a", encoding="utf-8") as log:
        log.write(f"started: {' '.join(command)}\n")
        log.flush()
        # As many threads as the engine gives this step, not as many as the machine has.
        environment = os.environ | {"RAYON_NUM_THREADS": str(told.threads)}
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.PIPE, env=environment, check=False
            )
        except OSError as error:
            log.write(f"ended: {error}\n")
            return 1, f"{command[0]}: {error.strerror}: set host_sim in config.yaml"
        said = done.stderr.decode(errors="replace")
        log.write(f"{said}ended: exit code {done.returncode}{_cost()}\n")
    return done.returncode, _telling(said)


def _cost() -> str:
    """What it took, where the system tells: to choose memory_mb, and to reckon what a season costs."""
    try:
        import resource
    except ImportError:
        return ""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    # Kilobytes, but for macOS.
    megabytes = used.ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
    return f", {used.ru_utime + used.ru_stime:.2f} s of processor, {megabytes:.0f} MB"


def _telling(said: str) -> str:
    """Of a wrong option the first line, else the last: warnings stand before the error."""
    lines = [line.strip() for line in said.splitlines() if line.strip()] or ["nothing was said"]
    return next((line for line in lines if line.startswith("error: ")), lines[-1])[:LONGEST_MESSAGE]


def _write(told: argparse.Namespace, outcome: str, message: str | None, without: str | None) -> int:
    results = list(told.results) if outcome == "done" else []
    if told.without_pages:
        for folder in {Path(result).parent for result in results}:
            (folder / "report.html").unlink(missing_ok=True)
    text = {"schema": 1, "outcome": outcome, "message": message, "without": without, "results": results}
    told.outcome.parent.mkdir(parents=True, exist_ok=True)
    whole.replace(told.outcome, json.dumps(text, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
