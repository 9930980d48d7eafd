// One strip of the chart: some series over time, on a scale that follows, wraps or stays.
const MODES = ["auto", "wrapped", "fixed"];
const SPANS = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
const STRIPS = [
  { name: "Field", unit: "nT", digits: 2, least: 2, lines: [[1, "compensated", "first"], [0, "raw, scale on the right", "second"]], mode: "auto", span: 100 },
  { name: "Predicted deviation", unit: "nT", digits: 2, least: 1, lines: [[2, "raw less compensated", "first"]], mode: "auto", span: 100 },
  { name: "Residual", unit: "nT", digits: 3, least: 0.2, lines: [[3, "predictive, 0.1 to 0.9 Hz", "first"]], mode: "auto", span: 2, zero: true },
  { name: "Depth", unit: "m", digits: 1, least: 2, lines: [[4, "of the body", "first"]], mode: "auto", span: 20, down: true },
  { name: "Altitude", unit: "m", digits: 1, least: 2, lines: [[5, "above the bottom", "first"]], mode: "auto", span: 20, floor: true },
];
// `whenPressed` is told the time that was touched.
class Strip {
  constructor(form, whenPressed) {
    this.form = form;
    Object.assign(this, { mode: form.mode, span: form.span, centres: null }, settings.get(`strip ${form.name}`, {}));
    this.box = element("section", null, "strip");
    this.head = element("p");
    this.head.append(element("strong", form.name));
    for (const [, label, ink] of form.lines) {
      const key = element("b", label, `${ink === "second" ? "thin" : ""}${form.lines.length > 1 ? "" : " only"}`);
      key.style.setProperty("--line", `var(--${ink})`);
      this.head.append(key);
    }
    this.scale = this.head.appendChild(element("em"));
    this.room = element("div", null, "canvas");
    this.box.append(this.head, this.room);
    this.room.addEventListener("click", (event) => {
      if (this.plot) whenPressed(this.plot.posToVal(event.clientX - this.plot.over.getBoundingClientRect().left, "x"), this);
    });
    this.plot = null;
    this.isFirst = false;
  }
  // The chart is made when there is room for it, and follows the room.
  fit(options) {
    const [width, height] = [Math.floor(this.room.clientWidth), Math.floor(this.room.clientHeight)];
    if (width < 40 || height < 40) return;
    if (!this.plot) this.plot = new uPlot(options(this, width, height), [[0], ...this.form.lines.map(() => [null])], this.room);
    else if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({ width, height });
  }
  isKnown() {
    return this.form.lines.some(([k]) => store.high.some((cell) => cell[k] != null));
  }
  draw() {
    if (!this.plot || store.last == null) return;
    const lines = this.form.lines.map(([k]) => k);
    const drawn = points(lines, this.mode === "wrapped" ? this.span : null);
    this.ranges = drawn.bounds.map((bounds, k) => this.scaled(bounds, lines[k]));
    this.plot.setData(drawn.data, false);
    this.plot.batch(() => {
      this.plot.setScale("x", { min: store.last - store.window, max: store.last });
      this.ranges.forEach(([min, max], k) => this.plot.setScale(`y${k}`, { min, max }));
    });
    const words = this.words();
    if (this.scale.textContent !== words) this.scale.textContent = words;
  }
  scaled([low, high], series) {
    const { least, zero, floor, down } = this.form;
    if (this.mode === "wrapped") return [0, this.span];
    if (this.mode === "fixed") {
      if (zero) return [-this.span / 2, this.span / 2];
      if (floor || down) return [0, this.span];
      this.centres ??= {};
      const centre = this.centres[series] ??= this.centreNow(series);
      return [(centre ?? 0) - this.span / 2, (centre ?? 0) + this.span / 2];
    }
    if (low > high) return [0, least];
    const room = Math.max(0.08 * (high - low), (least - (high - low)) / 2);
    if (zero) { const most = Math.max(-low, high, least / 2) * 1.08; return [-most, most]; }
    return [floor || down ? Math.max(0, low - room) : low - room, high + room];
  }
  recentre() {
    this.centres = null;
  }
  // On round figures, so that the grid is one that a person can read.
  centreNow(series) {
    const [value, step] = [store.latest[series], this.span / 4];
    return value == null ? null : Math.round(value / step) * step;
  }
  words() {
    const span = `${number(this.span, this.span < 1 ? 1 : 0)} ${this.form.unit}`;
    return this.mode === "auto" ? this.form.unit : this.mode === "wrapped" ? `wrapped at ${span}` : `fixed, ${span}`;
  }
  change(what) {
    Object.assign(this, what);
    if (what.span && this.mode === "auto") this.mode = "fixed";
    if (what.mode || what.span) this.centres = null;
    settings.set(`strip ${this.form.name}`, { mode: this.mode, span: this.span });
  }
}
// The cells as points: smallest and largest of each, with a hole where time or a wrapped scale jumps.
function points(lines, span) {
  const data = [[], ...lines.map(() => [])];
  const bounds = lines.map(() => [Infinity, -Infinity]);
  const turns = lines.map(() => null);
  const isFine = store.cell < 0.2;
  const first = store.last - store.window;
  let before = null;
  const put = (time, values) => {
    data[0].push(time);
    values.forEach((value, k) => data[k + 1].push(value));
  };
  for (let cell = 0; cell < store.time.length; cell++) {
    const time = store.time[cell];
    if (time < first - store.cell) continue;
    if (before != null && time - before > Math.max(2.5 * store.cell, 0.35)) put(before + store.cell / 2, lines.map(() => null));
    before = time;
    for (const [part, side] of [store.low, store.high].entries()) {
      if (isFine && part) break;
      const values = lines.map((k) => side[cell][k]);
      const wrapped = values.map((value) => value == null || span == null ? value : value - span * Math.floor(value / span));
      const turn = values.map((value) => value == null || span == null ? null : Math.floor(value / span));
      const jumps = turn.map((now, k) => now != null && turns[k] != null && now !== turns[k]);
      const when = time + part * store.cell / 2;
      // `undefined` is no hole in the other line.
      if (jumps.includes(true)) put(when - 1e-3, jumps.map((jump) => jump ? null : undefined));
      turn.forEach((now, k) => { if (now != null) turns[k] = now; });
      put(when, wrapped);
      wrapped.forEach((value, k) => {
        if (value != null) bounds[k] = [Math.min(bounds[k][0], value), Math.max(bounds[k][1], value)];
      });
    }
  }
  return { data, bounds };
}
// What all strips have in common.
function stripOptions(picked) {
  return (strip, width, height) => {
    const axis = { stroke: () => colour("ink"), grid: { stroke: () => colour("grid"), width: 1 }, ticks: { show: false }, font: "14px system-ui, sans-serif" };
    const sizes = { size: width < 500 ? 58 : 70, space: (u, axis, low, high, room) => (room < 70 ? 15 : 24), values: (u, splits) => splits.map((v) => Number(v.toFixed(6)).toLocaleString("en", { maximumFractionDigits: 4 }).replace("-", "−")) };
    const dir = strip.form.down ? -1 : 1;
    return {
      width, height, legend: { show: false }, padding: [8, strip.form.lines.length > 1 ? 0 : sizes.size, 4, 0],
      cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false, auto: false }, y0: { auto: false, dir }, y1: { auto: false, dir } },
      axes: [
        // The time is written once, under the strip that is never out of sight.
        { ...axis, size: () => (strip.isFirst ? 22 : 0), space: 90, values: (u, splits) => splits.map((s) => (strip.isFirst ? clock(s) : "")), incrs: [1, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 10800] },
        ...strip.form.lines.map(([, , ink], k) => ({ ...axis, ...sizes, scale: `y${k}`, side: k ? 1 : 3, stroke: () => colour(k ? ink : "ink"), grid: k ? { show: false } : axis.grid })),
      ],
      series: [{}, ...strip.form.lines.map(([, , ink], k) => ({ scale: `y${k}`, stroke: () => colour(ink), width: ink === "first" ? 2 : 1.5, dash: ink === "first" ? undefined : [6, 4], points: { show: false }, spanGaps: false }))],
      hooks: { draw: [(u) => notices(u, picked(), strip.isFirst)] },
    };
  };
}
// Marks, contacts and the time that was touched, as lines across a strip.
function notices(u, picked, isFirst) {
  const { ctx, bbox } = u;
  const line = (time, ink, label, dash) => {
    if (time < u.scales.x.min || time > u.scales.x.max) return;
    const x = Math.round(u.valToPos(time, "x", true));
    ctx.strokeStyle = ctx.fillStyle = ink;
    ctx.setLineDash(dash);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    // Said once, on the first strip: it hides what is behind it.
    if (!label || !isFirst) return;
    const [left, top] = [x + 3 * devicePixelRatio, bbox.top + 14 * devicePixelRatio];
    ctx.fillStyle = colour("paper");
    ctx.fillRect(left, top - 13 * devicePixelRatio, ctx.measureText(label).width + 4 * devicePixelRatio, 17 * devicePixelRatio);
    ctx.fillStyle = ink;
    ctx.fillText(label, left + 2 * devicePixelRatio, top);
  };
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.lineWidth = 2 * devicePixelRatio;
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  ctx.font = `bold ${14 * devicePixelRatio}px system-ui, sans-serif`;
  for (const mark of store.marks) line(mark.time_s, colour("mark"), mark.label || "mark", [8, 4]);
  for (const contact of store.contacts) line(contact.time_s, colour("contact"), `T${contact.number}`, []);
  if (picked != null) line(picked, colour("ink"), "", [2, 3]);
  ctx.restore();
}
