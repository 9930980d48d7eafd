"""Fit how sure `diagnose` says that an input drives what has no name, on recordings of trials whose answers are known.

    host-sim trial --setting tuning --only foreign --recordings 120 --minutes 4 --seed 711 --out tuned
    python trial/baselines/driver_calibration.py tuned

Prints the calibration error as it is and what chance makes of it, what was said beside how often it was right, and the best of two
constants of `host-sim/src/diagnosis/policy/drivers.rs`: a factor of all log odds (of DRIVER_SHARPNESS and DRIVER_BEHIND), and what none
of it tells (DRIVER_UNSURE; `--unsure` is what it was in the run). The best is that of the least log loss: an error of ten bins is flat.
The error with each half of the recordings fitted and the other judged says what the fit itself gains. `--constants 0.8 0.12` prints
the error with a factor and an unsureness that were chosen elsewhere, too.
"""

import argparse
import json
import math
import random
from itertools import product
from pathlib import Path

NOT_RECORDED = {"none", "time_periodic", "time_irregular"}
FACTORS = [0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.25, 1.5]
UNSURE = [0.0, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2]
DRAWS = 400
LEAST_STRENGTH = 3.0
BINS = 10


def answers_of(folder):
    """The drivers' probabilities of each described recording that hides one thing, with those that are right."""
    answers = json.loads((folder / "answers.json").read_text())
    results = json.loads((folder / "trial.json").read_text())["results"]
    for answer, result in zip(answers, results, strict=True):
        rest = result["diagnosis"].get("unexplained") or {}
        drivers = {driver["input"]: driver["probability"] for driver in rest.get("drivers", [])}
        hidden = answer["hidden"]
        if drivers and len(hidden) == 1 and hidden[0]["strength"] > 0.8 * LEAST_STRENGTH:
            yield drivers, set(answer.get("drivers", [])) or NOT_RECORDED


def told(drivers, unsure):
    """What the odds alone tell, without what all inputs share alike."""
    return {name: max(0.0, p - unsure / len(drivers)) / (1.0 - unsure) for name, p in drivers.items()}


def changed(drivers, factor, unsure):
    """The probabilities with other constants, of what the odds alone tell."""
    odds = {name: max(p, 1e-300) ** factor for name, p in drivers.items()}
    total = sum(odds.values())
    return {name: (1.0 - unsure) * one / total + unsure / len(odds) for name, one in odds.items()}


def promised(drivers, right):
    """Of the first driver, as the trial counts it, and whether it is right."""
    first = max(drivers, key=drivers.get)
    alike = NOT_RECORDED if first in NOT_RECORDED else {first}
    return sum(p for name, p in drivers.items() if name in alike), first in right


def calibration_error(all_drivers):
    return error_of([promised(drivers, right) for drivers, right in all_drivers])


def error_of(said):
    said = sorted(said)
    edges = [k * len(said) // BINS for k in range(BINS + 1)]
    off = (abs(sum(p - is_right for p, is_right in said[a:b])) for a, b in zip(edges, edges[1:]))
    return sum(off) / len(said)


def by_chance(all_drivers):
    """The error in the mean, were each first driver right as often as it says."""
    draw = random.Random(1)
    said = [promised(*one)[0] for one in all_drivers]
    return sum(error_of([(p, draw.random() < p) for p in said]) for _ in range(DRAWS)) / DRAWS


def loss(all_drivers, constants):
    """Mean log loss of what is right."""
    total = 0.0
    for drivers, right in all_drivers:
        of_right = sum(p for name, p in changed(drivers, *constants).items() if name in right)
        total -= math.log(max(of_right, 1e-9))
    return total / len(all_drivers)


def best(all_drivers):
    return min(product(FACTORS, UNSURE), key=lambda constants: loss(all_drivers, constants))


def with_constants(all_drivers, constants):
    return [(changed(drivers, *constants), right) for drivers, right in all_drivers]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trials", nargs="+", type=Path, help="folders of trials")
    parser.add_argument("--unsure", type=float, default=0.12, help="DRIVER_UNSURE of the program that made them")
    parser.add_argument("--constants", type=float, nargs=2, metavar=("FACTOR", "UNSURE"), help="others to be judged")
    arguments = parser.parse_args()
    own = [one for folder in arguments.trials for one in answers_of(folder)]
    right = sum(promised(*one)[1] for one in own)
    print(f"{len(own)} recordings, first driver right on {right}; error as it is {calibration_error(own):.3f},")
    print(f"  of which chance makes {by_chance(own):.3f}")
    said = sorted(promised(*one) for one in own)
    for part in (said[: len(said) // 2], said[len(said) // 2 :]):
        mean = sum(p for p, _ in part) / max(1, len(part))
        print(f"  {len(part)} said with {mean:.2f} in the mean: {sum(is_right for _, is_right in part)} right")
    own = [(told(drivers, arguments.unsure), right) for drivers, right in own]
    if arguments.constants:
        others = with_constants(own, arguments.constants)
        print(f"with {arguments.constants}: error {calibration_error(others):.3f}, of which chance makes {by_chance(others):.3f}")
    constants = best(own)
    fitted = with_constants(own, constants)
    right = sum(promised(*one)[1] for one in fitted)
    print(f"best: log odds times {constants[0]}, {constants[1]} unsure")
    print(f"  right on {right}; error {calibration_error(fitted):.3f}, on those it was fitted to")
    halves = own[::2], own[1::2]
    crossed = [one for fit, judge in (halves, halves[::-1]) for one in with_constants(judge, best(fit))]
    print(f"  error {calibration_error(crossed):.3f} with each half fitted to the other")


if __name__ == "__main__":
    main()
