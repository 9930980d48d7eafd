// Alarms: a tone until a person has seen every one of them. On a screen that may only look, the tone can be stopped here
// alone, until there is another alarm.
const alarms = {
  all: [], silenced: "", context: null, beeps: 0,
  isOn: settings.get("sound", true),
  show(list, mayMark) {
    this.all = list;
    const box = at("alarms");
    const texts = box.textContent;
    const made = list.map((alarm) => this.entry(alarm, mayMark));
    const now = made.map((entry) => entry.textContent).join("");
    if (now !== texts) box.replaceChildren(...made);
    this.sound();
  },
  entry(alarm, mayMark) {
    const box = element("div", null, `alarm ${alarm.is_acknowledged ? "seen" : "sounding"}`);
    const text = element("p", alarm.text);
    const state = alarm.is_acknowledged ? "seen, and goes on" : alarm.is_over && alarm.kind !== "target" ? "over by now" : alarm.kind === "target" ? "passed" : "goes on";
    text.append(element("small", `since ${clock(alarm.since_s)}: ${state}`));
    box.append(text);
    if (alarm.is_acknowledged) return box;
    const button = element("button", mayMark ? "Seen" : "Quiet here");
    button.addEventListener("click", () => (mayMark ? send({ want: "acknowledge", alarm: alarm.kind }) : this.silence()));
    box.append(button);
    return box;
  },
  names() {
    return this.all.filter((alarm) => !alarm.is_acknowledged).map((alarm) => alarm.kind + alarm.since_s).join();
  },
  first() {
    return this.all.find((alarm) => !alarm.is_acknowledged);
  },
  silence() {
    this.silenced = this.names();
  },
  isSounding() {
    return this.isOn && this.names() !== "" && this.names() !== this.silenced;
  },
  // Browsers let nothing sound before somebody has touched the page.
  wake() {
    this.context ??= new (window.AudioContext || window.webkitAudioContext)();
    if (this.context.state === "suspended") this.context.resume();
  },
  isReady() {
    return this.context?.state === "running";
  },
  sound() {
    if (!this.isSounding() || !this.isReady()) return;
    const begin = this.context.currentTime + 0.02;
    if (begin < (this.until ?? 0)) return;
    this.until = begin + 1.2;
    this.beeps += 1;
    // Two tones a fifth apart: heard over an engine, and told from a kettle.
    for (const [k, hz] of [880, 587, 880].entries()) this.tone(hz, begin + 0.25 * k);
  },
  tone(hz, begin) {
    const [oscillator, gain] = [this.context.createOscillator(), this.context.createGain()];
    oscillator.type = "square";
    oscillator.frequency.value = hz;
    gain.gain.setValueAtTime(0.25, begin);
    gain.gain.setValueAtTime(0, begin + 0.2);
    oscillator.connect(gain).connect(this.context.destination);
    oscillator.start(begin);
    oscillator.stop(begin + 0.25);
  },
};
setInterval(() => alarms.sound(), 300);
