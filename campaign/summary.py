"""The summary of one campaign or of several: a page, tables, and summary.json for another program.

Made of what the steps have left, in the order of the seasons' tables, without a time or a folder in it: the same results
give the same bytes, whoever made them and in whichever order.
"""

import argparse
import csv
import io
import json
import sys
from collections import Counter
from pathlib import Path

import compare
import page
import results
import season
import whole

COLUMNS = (
    *("name", "body", "day", "kind", "calibration", "import", "calibrate", "survey", "diagnose", "format"),
    *("rows_in", "rows_out", "rows_invalid", "duration_s", "improvement_ratio", "condition_number", "noise_floor_nT"),
    *("contacts", "smallest_moment_Am2", "verdict", "effects", "residual_rms_nT", "noise_rms_nT", "targets"),
    *("unexplained", "summary", "problems", "notes", "programs", "sources_sha256"),
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("campaigns", nargs="+", type=Path, help="folders of campaigns")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--season", default="season.csv", help="name of the table in each folder")
    told = parser.parse_args()
    try:
        all_results = [one for folder in told.campaigns for one in results.read(folder, told.season)]
    except season.SeasonError as error:
        print(error, file=sys.stderr)
        return 2
    trials = [trial for folder in told.campaigns for trial in results.trials(folder)]
    unknowns = [cluster for folder in told.campaigns for cluster in results.unknowns(folder)]
    summary = summed(all_results, trials, unknowns)
    texts = {
        "recordings.csv": table(COLUMNS, [_flat(one) for one in all_results]),
        "coefficients.csv": table(("name", "body", "day", "kind", "term", "value", "std", "unit"), _coefficients(all_results)),
        "contacts.csv": table(_contact_columns(all_results), [contact for one in all_results for contact in one.contacts]),
        "index.html": page.page(summary, all_results),
        "summary.json": json.dumps(summary, indent=2) + "\n",
    }
    told.out.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        whole.replace(told.out / name, text)
    print(page.headline(summary))
    for problem in summary["problems"]:
        print(f"{problem['name']}: {problem['what']}")
    return 0


def summed(all_results: list[results.Results], trials: list[dict], unknowns: list[dict] = ()) -> dict:
    """What summary.json holds."""
    days = compare.days_of(all_results)
    programs = Counter(program for one in all_results for program in one.programs)
    bodies = sorted({one.recording.body for one in all_results})
    return {
        "schema": 1,
        **compare.summed(all_results),
        "steps": dict(sorted(Counter(_steps(all_results)).items())),
        "programs": [{"version": of[0], "commit": of[1], "results": count} for of, count in sorted(programs.items())],
        "problems": [{"name": one.recording.name, "what": what} for one in all_results for what in one.problems],
        "notes": [{"name": one.recording.name, "what": what} for one in all_results for what in one.notes],
        "bodies": [
            {"body": body, **compare.summed([one for one in all_results if one.recording.body == body])} for body in bodies
        ],
        "days": [_day(row) for row in days],
        "unknowns": list(unknowns),
        "trials": trials,
    }


def _steps(all_results: list[results.Results]):
    for one in all_results:
        for step in season.STEPS[one.recording.kind]:
            yield one.row[step]


def _day(row: dict) -> dict:
    means = [
        {"term": term, "value": mean.value, "std": mean.std, "unit": unit}
        for term, unit, mean in zip(results.TERMS, results.UNITS, row["means"])
        if mean
    ]
    changed = [{"term": term, "standard_deviations": change} for term, change in row["changed"]]
    left_out = ("means", "changes", "changed")
    first = {"body": row["body"], "day": row["day"]}
    return first | {key: row[key] for key in row if key not in left_out} | {"coefficients": means, "changed": changed}


def table(columns: tuple[str, ...], rows: list[dict]) -> str:
    """A CSV file; what a row does not have is empty."""
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _flat(one: results.Results) -> dict:
    programs = " ".join(sorted({f"{version}@{commit}" for version, commit in one.programs}))
    return one.row | {"problems": "; ".join(one.problems), "notes": "; ".join(one.notes), "programs": programs}


def _coefficients(all_results: list[results.Results]) -> list[dict]:
    rows = []
    for one in all_results:
        for term, unit, (value, std) in zip(results.TERMS, results.UNITS, one.coefficients):
            rows.append(one.row | {"term": term, "value": value, "std": std, "unit": unit})
    return rows


def _contact_columns(all_results: list[results.Results]) -> tuple[str, ...]:
    # In the order in which they are first seen: a campaign may be of several versions of the program.
    names = dict.fromkeys(("name", "body", "day"))
    for one in all_results:
        for contact in one.contacts:
            names |= dict.fromkeys(contact)
    return tuple(names)


if __name__ == "__main__":
    sys.exit(main())
