"""What differs between bodies and days."""

from collections import Counter
from dataclasses import dataclass
from math import sqrt
from statistics import NormalDist, median

from results import TERMS, Results

# Chance that a body that never changes is said to have changed anywhere in a campaign.
FALSE_ALARM = 0.01


@dataclass(frozen=True)
class Mean:
    """Of a coefficient over the recordings of a day."""

    value: float
    std: float


def mean(estimates: list[tuple[float, float]]) -> Mean | None:
    """Weighted by the variances that the recordings tell. Where they scatter more than those allow, the standard deviation is
    larger by as much (Birge 1932): coefficients also differ because the recordings' seas do."""
    known = [(value, std) for value, std in estimates if std > 0]
    if not known:
        return None
    weights = [1 / std**2 for _, std in known]
    value = sum(weight * value for weight, (value, _) in zip(weights, known)) / sum(weights)
    std = 1 / sqrt(sum(weights))
    if len(known) > 1:
        chi_squared = sum(weight * (one - value) ** 2 for weight, (one, _) in zip(weights, known))
        std *= max(1.0, sqrt(chi_squared / (len(known) - 1)))
    return Mean(value, std)


def days_of(results: list[Results]) -> list[dict]:
    """A row a body and day, with the change of its coefficients since its day before."""
    groups: dict[tuple[str, str], list[Results]] = {}
    for one in results:
        groups.setdefault((one.recording.body, one.recording.day), []).append(one)
    rows = [_day(*key, groups[key]) for key in sorted(groups)]
    previous: dict[str, dict] = {}
    for row in rows:
        known = row["means"] if any(row["means"]) else None
        row["changes"] = _changes(previous.get(row["body"]), known)
        if known:
            previous[row["body"]] = known
    limit = _limit(sum(len(row["changes"]) for row in rows))
    for row in rows:
        row["changed"] = sorted((one for one in row["changes"] if abs(one[1]) > limit), key=lambda one: -abs(one[1]))
    return rows


def _limit(tried: int) -> float:
    """In standard deviations, two-sided, for all that is tried together (Bonferroni)."""
    return NormalDist().inv_cdf(1 - FALSE_ALARM / (2 * max(1, tried)))


def _changes(before: list | None, now: list | None) -> list[tuple[str, float]]:
    if before is None or now is None:
        return []
    pairs = [(term, a, b) for term, a, b in zip(TERMS, before, now) if a and b]
    return [(term, (b.value - a.value) / sqrt(a.std**2 + b.std**2)) for term, a, b in pairs]


def _day(body: str, day: str, results: list[Results]) -> dict:
    # Of the tows alone: a calibration is penalised, and on land the body lies otherwise, so that it would seem a change.
    known = [one.coefficients for one in results if one.recording.kind == "tow" and one.coefficients]
    return summed(results) | {
        "body": body,
        "day": day,
        "means": [mean([one[term] for one in known]) for term in range(len(TERMS))],
    }


def summed(results: list[Results]) -> dict:
    """What is counted of a body, a day, or all."""
    tows = [one.row for one in results if one.row.get("survey") == "done"]
    hours = sum(row["duration_s"] for row in tows) / 3600
    contacts = sum(row["contacts"] for row in tows)
    noise = [row["noise_floor_nT"] for row in tows if row["noise_floor_nT"] is not None]
    return {
        "recordings": len(results),
        "bad": sum(bool(one.problems) for one in results),
        "hours": hours,
        "contacts": contacts,
        "contacts_per_hour": contacts / hours if hours else None,
        "noise_floor_nT": median(noise) if noise else None,
        "diagnosed": sum("verdict" in one.row for one in results),
        "verdicts": dict(sorted(Counter(one.row["verdict"] for one in results if "verdict" in one.row).items())),
        "effects": effects_of(results),
    }


def effects_of(results: list[Results]) -> list[dict]:
    """Each effect that was named, on how many recordings, and its first parameter over them."""
    seen: dict[str, list[dict]] = {}
    for one in results:
        for effect in one.effects:
            seen.setdefault(effect["name"], []).append(effect)
    rows = []
    for name, effects in sorted(seen.items(), key=lambda item: (-len(item[1]), item[0])):
        first = [effect["parameters"][0] for effect in effects if effect["parameters"]]
        values = [parameter["value"] for parameter in first if parameter["value"] is not None]
        row = {"effect": name, "recordings": len(effects)}
        if values:
            row |= {"parameter": first[0]["name"], "median": median(values), "least": min(values), "most": max(values)}
        rows.append(row)
    return rows
