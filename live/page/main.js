// Strips, buttons and keys.
const strips = STRIPS.map((form) => new Strip(form, pick));
const screen_ = { picked: null, chosen: 0, drawn: 0, due: null, lastDrawn: 0, delays: [] };
const options = stripOptions(() => screen_.picked);
strips.forEach((strip, k) => {
  at("strips").append(strip.box);
  strip.head.addEventListener("click", () => choose(k));
});
new ResizeObserver(() => redraw(false)).observe(at("strips"));

// A touch names the time of the next mark; by itself it marks nothing: gloves and sleeves touch much.
function pick(time, strip) {
  screen_.picked = time;
  clearTimeout(screen_.forget);
  screen_.forget = setTimeout(unpick, 12000);
  choose(strips.indexOf(strip));
  showButtons();
  redraw(false);
}
function unpick() {
  screen_.picked = null;
  showButtons();
  redraw(false);
}
function mark() {
  if (!link.may.mark) return;
  send({ want: "mark", time_s: screen_.picked, label: at("label").value });
  at("label").value = "";
  unpick();
}
function choose(k) {
  screen_.chosen = (k + strips.length) % strips.length;
  showButtons();
}
function chooseNext(step) {
  let next = screen_.chosen;
  do next = (next + step + strips.length) % strips.length; while (strips[next].box.hidden && next !== screen_.chosen);
  choose(next);
}
function setWindow(seconds) {
  store.window = seconds;
  settings.set("window", seconds);
  askHistory(null);
  showButtons();
  redraw(false);
}
const chosen = () => strips[screen_.chosen];
function nextMode() {
  const hasWrap = chosen().form.unit === "nT";
  const modes = MODES.filter((mode) => hasWrap || mode !== "wrapped");
  chosen().change({ mode: modes[(modes.indexOf(chosen().mode) + 1) % modes.length] });
  showButtons();
  redraw(false);
}
function zoom(step) {
  const place = SPANS.findIndex((span) => span >= chosen().span) + step;
  chosen().change({ span: SPANS[Math.min(Math.max(place, 0), SPANS.length - 1)] });
  showButtons();
  redraw(false);
}
function recentre() {
  chosen().recentre();
  redraw(false);
}
function setColours(name) {
  document.documentElement.dataset.colours = name;
  settings.set("colours", name);
  showButtons();
  redraw(false);
}
const toggleColours = () => setColours(document.documentElement.dataset.colours === "day" ? "night" : "day");
function toggleSound() {
  // The first press only lets it sound, where nothing did yet.
  if (alarms.isReady() || !alarms.isOn) alarms.isOn = !alarms.isOn;
  settings.set("sound", alarms.isOn);
  alarms.wake();
  showButtons();
}
function acknowledge() {
  const first = alarms.first();
  if (first) alarms.seen(first);
}
function toggleKeys() {
  at("help").hidden = !at("help").hidden;
  if (!at("help").hidden) at("help").scrollIntoView({ block: "nearest" });
}
const KEYS = [
  ["m", "Mark now, or the time that was touched", mark],
  ["a", "Alarm seen", acknowledge],
  ["1 … 5", "2 min, 10 min, 1 h, 3 h, 12 h", null],
  ["ArrowDown", "Scale of the next strip", () => chooseNext(1)],
  ["ArrowUp", "Scale of the strip before", () => chooseNext(-1)],
  ["w", "Scale follows, wraps, or stays", nextMode],
  ["+", "Finer scale", () => zoom(-1)],
  ["-", "Coarser scale", () => zoom(1)],
  ["c", "Centre a fixed scale", recentre],
  ["n", "Day or night colours", toggleColours],
  ["s", "Sound on or off", toggleSound],
  ["Escape", "Forget the time that was touched", unpick],
  ["?", "These keys", toggleKeys],
];
for (const [key, words] of KEYS) at("keys").append(element("dt", key.replace("Arrow", "Arrow ")), element("dd", words));
for (const [k, [seconds, words]] of WINDOWS.entries()) {
  const button = element("button", words);
  button.dataset.seconds = seconds;
  button.title = `Key ${k + 1}`;
  button.addEventListener("click", () => setWindow(seconds));
  at("windows").append(button);
}
for (const [id, act] of [["mark", mark], ["which", () => chooseNext(1)], ["mode", nextMode], ["narrow", () => zoom(-1)], ["widen", () => zoom(1)], ["centre", recentre], ["colours", toggleColours], ["sound", toggleSound], ["keyhelp", toggleKeys]]) at(id).addEventListener("click", act);
addEventListener("keydown", (event) => {
  alarms.wake();
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === "INPUT") return;
  const digit = "12345".indexOf(event.key);
  const act = digit >= 0 && event.key ? () => setWindow(WINDOWS[digit][0]) : KEYS.find(([key]) => key.toLowerCase() === event.key.toLowerCase())?.[2];
  if (!act) return;
  event.preventDefault();
  act();
});
addEventListener("pointerdown", () => alarms.wake());
at("command").addEventListener("submit", (event) => {
  event.preventDefault();
  if (at("line").value.trim()) send({ want: "command", line: at("line").value });
  at("line").value = "";
});

function showHello(told) {
  document.title = `${told.title} – towmag live`;
  at("title").textContent = told.title;
  at("mark").hidden = at("labelling").hidden = !told.may_mark;
  at("command").hidden = !told.may_command;
  showLink();
}
const MODE_WORDS = { auto: "Follows", wrapped: "Wraps", fixed: "Stays" };
function showButtons() {
  strips.forEach((strip, k) => strip.box.classList.toggle("chosen", k === screen_.chosen));
  for (const button of at("windows").children) button.setAttribute("aria-pressed", Number(button.dataset.seconds) === store.window);
  at("which").textContent = `${chosen().form.name.replace("Predicted deviation", "Deviation")} ▾`;
  at("mode").textContent = MODE_WORDS[chosen().mode];
  at("centre").hidden = chosen().mode !== "fixed" || Boolean(chosen().form.zero || chosen().form.floor || chosen().form.down);
  at("colours").textContent = document.documentElement.dataset.colours === "day" ? "Night" : "Day";
  at("sound").textContent = !alarms.isOn ? "Sound is off" : alarms.isReady() ? "Sound is on" : "Tap for sound";
  at("sound").setAttribute("aria-pressed", alarms.isOn && alarms.isReady());
  at("mark").textContent = screen_.picked == null ? "Mark" : `Mark ${clock(screen_.picked)}`;
}

// Twenty pictures a second at most, and a new epoch at once. Half of the 100 ms between two epochs: with 80 one that is late leaves
// the next no time to catch up.
const LEAST_MS = 50;
function redraw(isNew) {
  if (isNew) screen_.isNew = true;
  if (screen_.due != null) return;
  const wait = Math.max(0, screen_.lastDrawn + LEAST_MS - performance.now());
  screen_.due = setTimeout(() => requestAnimationFrame(draw), wait);
}
function draw() {
  const { sent } = store;
  const isNew = screen_.isNew;
  Object.assign(screen_, { due: null, isNew: false, lastDrawn: performance.now() });
  at("place").hidden = store.track.length < 2;
  // A body without an altimeter needs no empty strip.
  for (const strip of strips) strip.box.hidden = store.last != null && strip.form.lines.every(([k]) => k > 3) && !strip.isKnown();
  strips.filter((strip) => !strip.box.hidden).forEach((strip, k) => {
    strip.isFirst = k === 0;
    strip.fit(options);
    strip.draw();
  });
  drawTrack(at("track"));
  showFigures();
  at("clock").textContent = store.last == null ? "" : `${clock(store.last)}${isUtc(store.last) ? " UTC" : ""}`;
  screen_.drawn += 1;
  // The next task after the frame: what was drawn is on its way to the screen.
  if (isNew && sent != null) requestAnimationFrame(() => setTimeout(() => {
    screen_.delays.push(Date.now() - 1000 * sent);
    if (screen_.delays.length > 2000) screen_.delays.shift();
  }));
}
setInterval(() => { showLink(); showButtons(); }, 500);
setColours(settings.get("colours", "day"));
showLamps(Object.fromEntries(LAMPS.map((name) => [name, { level: "unknown", word: "" }])));
showLists();
showButtons();
connect();
// For whoever measures.
window.towmag = { store, link, alarms, strips, screen: screen_ };
