"""Each deterministic effect of the library withheld: what `diagnose` says drives it, and what its proposal is worth.

    python trial/baselines/withheld.py target/debug/host-sim withheld --recordings 20 --minutes 4 --seed 9301

An effect is taken out of the library and hidden in every recording (`trial --withhold`). Counted where its strength is 3 and more and a rest
is described: whether its own driver comes first; what the proposal closes on parts held out, over what the effect itself closes once it is
back in the library (0 where nothing is proposed); and, where an effect is proposed, whether the next tow of the same body, without the
effect in the library and with the proposed effect file, is explained by that file. An effect whose trial is there is not tried again.
"""

import argparse
import json
import statistics
import subprocess
from pathlib import Path

# Those that are no chance and do not happen once in a recording; a load's current follows its own column.
EFFECTS = [
    "scalar_lag", "clock_drift", "averaging_window", "scalar_lowpass", "heading_error", "fluxgate_bias", "fluxgate_scale",
    "fluxgate_nonorthogonality", "fluxgate_temperature_drift", "fluxgate_nonlinearity", "permanent_temperature", "second_order", "eddy_lag",
    "depth_gradient", "swell_induction",
]  # fmt: skip
LEAST_STRENGTH = 3.0


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def trial(program, folder, effect, options):
    """Its answers and results; run where it is not there."""
    if not (folder / "trial.json").exists() or not json.loads((folder / "trial.json").read_text())["results"]:
        asked = ["--recordings", options.recordings, "--minutes", options.minutes, "--seed", options.seed]
        run(program, "trial", "--only", "single", "--withhold", effect, *asked, "--keep", "--out", folder)
    answers = json.loads((folder / "answers.json").read_text())
    return zip(answers, json.loads((folder / "trial.json").read_text())["results"], strict=True)


def is_next_explained(program, folder, index, effect):
    """Whether the proposal names the gap of the body's next tow."""
    recordings, first, then = folder / "recordings", folder / f"first{index:03}", folder / f"next{index:03}"
    run(program, "diagnose", recordings / f"{index:03}.csv", "--withhold", effect, "--out", first)
    proposed = first / "proposed_effect.toml"
    if not proposed.exists():
        return False
    with_it = ["--withhold", effect, "--effect-file", proposed, "--out", then]
    run(program, "diagnose", recordings / f"{index:03}_next.csv", *with_it)
    said = json.loads((then / "diagnosis.json").read_text())
    return said["verdict"] == "explained" and any(one["name"].startswith("proposed_") for one in said["effects"])


def row(program, effect, options):
    folder = options.out / effect
    right, of_true, explained, strong = [], [], [], 0
    for answer, result in trial(program, folder, effect, options):
        hidden = answer["hidden"]
        if len(hidden) != 1 or hidden[0]["name"] != effect or hidden[0]["strength"] < 0.8 * LEAST_STRENGTH:
            continue
        strong += 1
        rest = result["diagnosis"].get("unexplained") or {}
        if not rest.get("drivers"):
            continue
        right.append(rest["drivers"][0]["input"] in answer.get("drivers", []))
        closed = rest["gap_closed"]["fraction"] if rest.get("gap_closed") else 0.0
        back = [one for one in (result.get("put_back") or {}).get("effects", []) if one["name"] == effect]
        if back and back[0]["gap_closed"]["fraction"] > 0.0:
            of_true.append(closed / back[0]["gap_closed"]["fraction"])
        if rest.get("gap_closed"):
            explained.append(is_next_explained(program, folder, answer["index"], effect))
    return strong, right, of_true, explained


def line(name, strong, right, of_true, explained):
    median = f"{statistics.median(of_true):.2f}" if of_true else "–"
    counts = f"{sum(right)} of {len(right)} | {median} | {sum(explained)} of {len(explained)}"
    print(f"| {name} | {strong} | {counts} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="host-sim")
    parser.add_argument("out", type=Path)
    parser.add_argument("--recordings", type=int, default=20, help="of each effect")
    parser.add_argument("--minutes", type=float, default=4.0)
    parser.add_argument("--seed", type=int, default=9301)
    parser.add_argument("--effects", nargs="*", default=EFFECTS)
    options = parser.parse_args()
    print("| withheld | recordings | right driver first | share of the true one's, median | next tow explained |\n|---|---|---|---|---|")
    whole = 0, [], [], []
    for effect in options.effects:
        own = row(options.program, effect, options)
        whole = tuple(a + b for a, b in zip(whole, own))
        line(f"`{effect}`", *own)
    line("all", *whole)


if __name__ == "__main__":
    main()
