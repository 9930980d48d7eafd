"""The page of a campaign: one file, nothing to load, readable at night."""

from html import escape

import chart
import results as of_campaign
from results import Results

STYLE = """
:root { color-scheme: light dark; --ink: light-dark(#1a2330, #e4e9f0); --dim: light-dark(#5b6878, #97a3b3);
  --line: light-dark(#d5dbe3, #36414f); --bad: light-dark(#b3261e, #ff8a80); background: light-dark(#fff, #10161e); color: var(--ink); }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 1180px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .7rem .25rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--dim); font-weight: 500; } td.number { text-align: right; } .day { white-space: nowrap; } .bad { color: var(--bad); } .dim { color: var(--dim); }
.strips { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: .8rem; }
svg { width: 100%; } svg text { font-size: 10px; fill: var(--ink); } svg .scale { text-anchor: end; fill: var(--dim); }
svg .frame { fill: none; stroke: var(--line); } svg line { stroke: currentColor; } svg circle { fill: currentColor; }
.body0 { color: light-dark(#0b63b0, #6cb4ff); } .body1 { color: light-dark(#b25500, #ffac5f); } .body2 { color: light-dark(#1c7a3f, #6fd694); }
.body3 { color: light-dark(#8a2f9e, #dd96ee); } .body4 { color: light-dark(#7a6a00, #dccb52); } .body5 { color: light-dark(#a02347, #ff90ad); }
"""


def headline(summary: dict) -> str:
    """A campaign in a sentence."""
    bodies, days = len(summary["bodies"]), len({row["day"] for row in summary["days"]})
    count = summary["recordings"]
    bad = f"{summary['bad']} with a problem" if summary["bad"] else "none with a problem"
    return f"{_plural(count, 'recording')} of {_plural(bodies, 'body', 'bodies')} on {_plural(days, 'day')}, {bad}."


def page(summary: dict, all_results: list[Results]) -> str:
    """The whole page."""
    parts = [
        f"<h1>Campaign</h1><p>{escape(headline(summary))} {escape(_programs(summary))}</p>",
        _said("Problems", summary["problems"], "bad"),
        _said("To know", summary["notes"], "dim"),
        *(_season(summary) if all_results else []),
        _unknowns(summary["unknowns"]),
        _trials(summary["trials"]),
        *([_recordings(all_results)] if all_results else []),
    ]
    head = f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Campaign</title><style>{STYLE}</style>'
    return head + "".join(parts) + "</html>\n"


def _season(summary: dict) -> list[str]:
    return [
        "<h2>Bodies</h2>" + _groups(summary["bodies"], ("body",)),
        "<h2>Days</h2>" + _groups(summary["days"], ("body", "day"), _changed),
        _effects(summary),
        _strips(summary),
    ]


def _plural(count: int, one: str, many: str | None = None) -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"


def _programs(summary: dict) -> str:
    made = [f"{of['version']} at {of['commit'][:10]}{'+' * of['commit'].endswith('+')}" for of in summary["programs"]]
    if len(made) > 1:
        return f"Made by {len(made)} programs, whose figures may differ: {', '.join(made)}."
    return f"Made by host-sim {made[0]}." if made else ""


def _said(title: str, rows: list[dict], look: str) -> str:
    if not rows:
        return ""
    lines = [[f'<span class="{look}">{escape(row["name"])}</span>', escape(row["what"])] for row in rows]
    return f"<h2>{title}</h2>" + _table(("recording", "what"), lines)


def _table(titles, rows) -> str:
    head = "".join(f"<th>{title}</th>" for title in titles)
    body = "".join("<tr>" + "".join(_cell(value) for value in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><tr>{head}</tr>{body}</table></div>'


def _cell(value) -> str:
    """Text is HTML already; numbers to what can be told of them."""
    if value is None:
        return '<td class="number dim">-</td>'
    if isinstance(value, str):
        return f"<td>{value}</td>"
    return f'<td class="number">{value if isinstance(value, int) else format(value, ".4g")}</td>'


def _groups(rows: list[dict], keys: tuple[str, ...], last=None) -> str:
    titles = [*keys, "recordings", "bad", "hours", "noise floor, nT", "contacts", "an hour", "verdicts", "effects named"]
    lines = []
    for row in rows:
        verdicts = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in row["verdicts"].items())
        named = ", ".join(f"{effect['effect']} on {effect['recordings']} of {row['diagnosed']}" for effect in row["effects"])
        line = [_word(row[key]) for key in keys]
        line += [row["recordings"], row["bad"], row["hours"], row["noise_floor_nT"], row["contacts"], row["contacts_per_hour"]]
        lines.append([*line, verdicts, escape(named), *([last(row)] if last else [])])
    return _table([*titles, *(["changed since the day before"] if last else [])], lines)


def _word(text: str) -> str:
    """What is not to be broken."""
    return f'<span class="day">{escape(text)}</span>'


def _changed(row: dict) -> str:
    told = [f"{one['term']} by {one['standard_deviations']:+.1f} σ" for one in row["changed"][:3]]
    more = [f"and {len(row['changed']) - 3} more"] if len(row["changed"]) > 3 else []
    return escape(", ".join(told + more))


def _effects(summary: dict) -> str:
    if not summary["effects"]:
        return ""
    rows = []
    for effect in summary["effects"]:
        share = f"{effect['recordings']} of {summary['diagnosed']}"
        values = [effect.get(key) for key in ("median", "least", "most")]
        rows.append([escape(effect["effect"]), share, escape(effect.get("parameter", "")), *values])
    return "<h2>Effects</h2>" + _table(("effect", "recordings", "parameter", "median", "least", "most"), rows)


def _strips(summary: dict) -> str:
    days = sorted({row["day"] for row in summary["days"]})
    bodies = [body["body"] for body in summary["bodies"]]
    at = {(row["body"], row["day"]): row for row in summary["days"]}

    def series(value):
        return [[value(at[body, day]) if (body, day) in at else None for day in days] for body in bodies]

    def of_term(term):
        def value(row):
            found = [one for one in row["coefficients"] if one["term"] == term]
            return (found[0]["value"], found[0]["std"]) if found else None

        return value

    noise = series(lambda row: (row["noise_floor_nT"], 0.0) if row["noise_floor_nT"] is not None else None)
    pictures = [chart.strip("noise floor", days, noise, "nT")]
    for term, unit in zip(of_campaign.TERMS, of_campaign.UNITS):
        pictures.append(chart.strip(term, days, series(of_term(term)), unit))
    key = " ".join(f'<span class="body{index % 6}">● {escape(body)}</span>' for index, body in enumerate(bodies))
    about = "Mean of a day's tows and its standard deviation, in the units of eq. (4)."
    return f'<h2>Over the season</h2><p>{key} <span class="dim">{about}</span></p><div class="strips">{"".join(pictures)}</div>'


def _unknowns(clusters: list[dict]) -> str:
    if not clusters:
        return ""
    rows = []
    for one in clusters:
        file = f'<a href="../unknowns/{escape(one["effect_file"])}">{escape(one["effect_file"])}</a>' if one["effect_file"] else ""
        rows.append([escape(one["text"]), escape(", ".join(one["seen_on"] or one["members"])), file])
    about = "What the diagnoses of several recordings could not name, and what goes with it."
    return f'<h2>Unknown causes that come again</h2><p class="dim">{about}</p>' + _table(("", "recordings", "proposed effect"), rows)


def _trials(trials: list[dict]) -> str:
    if not trials:
        return ""
    titles = list(dict.fromkeys(name for trial in trials for name in trial["rates"]))
    rows = []
    for trial in trials:
        rates = [trial["rates"].get(name) for name in titles]
        shown = [f"{rate['hits']} of {rate['of']}" if rate else None for rate in rates]
        rows.append([trial["seed"], trial["recordings"], *shown])
    return "<h2>Blind trials</h2>" + _table(("seed", "recordings", *(name.replace("_", " ") for name in titles)), rows)


def _recordings(all_results: list[Results]) -> str:
    titles = ("recording", "body", "day", "kind", "noise floor, nT", "contacts", "verdict", "effects", "unexplained", "problem")
    rows = []
    for one in all_results:
        row = one.row
        text = [escape(str(row.get(key) or "")) for key in ("verdict", "effects", "unexplained")]
        problem = f'<span class="bad">{escape("; ".join(one.problems))}</span>'
        first = [_linked(one), *(_word(row[key]) for key in ("body", "day", "kind"))]
        rows.append([*first, row.get("noise_floor_nT"), row.get("contacts"), *text, problem])
    return "<h2>Recordings</h2>" + _table(titles, rows)


def _linked(one: Results) -> str:
    """To the folder of its results, beside the summary."""
    name = _word(one.recording.name)
    return f'<a href="../results/{escape(one.recording.name)}/">{name}</a>' if "verdict" in one.row else name
