"""Small pictures for the page, as SVG."""

from html import escape

WIDTH, HEIGHT = 240, 96
LEFT, RIGHT, TOP, BOTTOM = 6, 6, 22, 16


def strip(title: str, days: list[str], series: list[list[tuple[float, float] | None]], unit: str) -> str:
    """Values with their standard deviations over days; of each body a line of dots of its own. The scale is that of the values."""
    low, high = _range(series)
    x = {day: LEFT + (WIDTH - LEFT - RIGHT) * (at + 0.5) / len(days) for at, day in enumerate(days)}
    y = lambda value: TOP + (HEIGHT - TOP - BOTTOM) * (high - value) / (high - low)
    marks = []
    for body, values in enumerate(series):
        shift = 5 * (body - (len(series) - 1) / 2)
        for day, at in zip(days, values):
            if at is not None:
                marks.append(_mark(x[day] + shift, y, at, body, f"{day}: {at[0]:.5g} ± {at[1]:.2g} {unit}"))
    scale = f"{low:.3g} to {high:.3g} {unit}"
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(title)}">'
        f'<rect class="frame" x="1" y="{TOP - 4}" width="{WIDTH - 2}" height="{HEIGHT - TOP - BOTTOM + 8}"/>'
        f'<text x="2" y="12">{escape(title)}</text><text class="scale" x="{WIDTH - 2}" y="12">{escape(scale)}</text>'
        f'{"".join(marks)}<text x="2" y="{HEIGHT - 1}">{escape(days[0][5:])}</text>'
        f'<text class="scale" x="{WIDTH - 2}" y="{HEIGHT - 1}">{escape(days[-1][5:])}</text></svg>'
    )


def _range(series: list[list[tuple[float, float] | None]]) -> tuple[float, float]:
    ends = [end for values in series for at in values if at is not None for end in (at[0] - at[1], at[0] + at[1])]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _mark(x: float, y, at: tuple[float, float], body: int, told: str) -> str:
    value, std = at
    return (
        f'<g class="body{body % 6}"><title>{escape(told)}</title>'
        f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{y(value - std):.1f}" y2="{y(value + std):.1f}"/>'
        f'<circle cx="{x:.1f}" cy="{y(value):.1f}" r="2.5"/></g>'
    )
