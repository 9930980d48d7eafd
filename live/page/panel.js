// All that is no chart: lamps, figures, lists.
const LAMPS = ["sensor", "adaptation", "log", "card", "cable", "time", "ship"];
const SIGNS = { good: "✓", warn: "!", bad: "✕", unknown: "?" };
let lampsTold = null;
let isStale = false;
function showLamps(lamps) {
  lampsTold = lamps;
  const boxes = LAMPS.map((name) => {
    const { word } = lamps[name];
    const level = isStale ? "unknown" : lamps[name].level;
    const box = element("div", null, `lamp ${level}`);
    box.append(element("span", name === "ship" ? "on the ship" : name), element("b", `${SIGNS[level]} ${isStale && word ? "was: " : ""}${word || "not known"}`));
    return box;
  });
  at("lamps").replaceChildren(...boxes);
}
// What was, and is not known to be so any more.
function showStale(isSo) {
  if (isSo === isStale) return;
  isStale = isSo;
  document.body.classList.toggle("stale", isSo);
  if (lampsTold) showLamps(lampsTold);
}
const FIGURES = [[1, "compensated", "nT", 2], [0, "raw", "nT", 2], [3, "residual", "nT", 3], [4, "depth", "m", 1], [5, "altitude", "m", 1], [null, "battery", "V", 1]];
const figureBoxes = FIGURES.map(([, name]) => {
  const box = element("div", null, "figure");
  const value = element("b");
  box.append(element("span", name), value);
  at("figures").append(box);
  return value;
});
function showFigures() {
  FIGURES.forEach(([k, name, unit, digits], place) => {
    const value = k == null ? store.battery : store.latest[k];
    const box = figureBoxes[place];
    box.parentElement.hidden = value == null && k == null;
    const text = number(value, digits, name === "residual");
    if (box.dataset.text !== text) {
      box.dataset.text = text;
      box.replaceChildren(text, element("small", ` ${unit}`));
    }
  });
}
function showList(id, notices, words) {
  const shown = notices.slice(-60).reverse().map((notice) => element("li", words(notice)));
  at(id).replaceChildren(...shown);
}
const markWords = (mark) => `${clock(mark.time_s)} ${mark.label || "mark"}`;
function contactWords(contact) {
  const where = contact.position_deg ? `, ${degrees(contact.position_deg[0], "N", "S")} ${degrees(contact.position_deg[1], "E", "W")}` : "";
  return `T${contact.number} at ${clock(contact.time_s)}: ${number(contact.peak_nt, 1, true)} nT, ${number(contact.width_s, 1)} s wide, signal to noise ${number(contact.snr, 0)}${where}`;
}
function showLists() {
  showList("marks", store.marks, markWords);
  showList("contacts", store.contacts, contactWords);
  showList("texts", store.texts, (text) => text);
}
