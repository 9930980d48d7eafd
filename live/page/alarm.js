// Alarms: a tone until a person has seen every one of them. On a screen that may only look, the tone can be stopped here
// alone, until there is another alarm. The page has one of its own, for then it hears of no other: when its connection is lost.
const alarms = {
  all: [], told: [], mayMark: false, lostSince: null, silenced: "", context: null, beeps: 0,
  isOn: settings.get("sound", true),
  show(told, mayMark) {
    Object.assign(this, { told, mayMark });
    this.list();
  },
  // Over when the connection is there again: the gap is filled, and what rang meanwhile rings on.
  lost(since) {
    if (this.lostSince === since) return;
    this.lostSince = since;
    this.list();
  },
  list() {
    const own = { kind: "page", text: "No connection: nothing here is new", since_s: this.lostSince, is_acknowledged: false, is_over: false };
    this.all = this.lostSince == null ? this.told : [own, ...this.told];
    const box = at("alarms");
    const texts = box.textContent;
    const made = this.all.map((alarm) => this.entry(alarm));
    const now = made.map((entry) => entry.textContent).join("");
    if (now !== texts) box.replaceChildren(...made);
    this.sound();
  },
  entry(alarm) {
    const box = element("div", null, `alarm ${alarm.is_acknowledged ? "seen" : "sounding"}`);
    const text = element("p", alarm.text);
    const state = alarm.is_acknowledged ? "seen, and goes on" : alarm.is_over && alarm.kind !== "target" ? "over by now" : alarm.kind === "target" ? "passed" : "goes on";
    text.append(element("small", `since ${clock(alarm.since_s)}: ${state}`));
    box.append(text);
    if (alarm.is_acknowledged) return box;
    const button = element("button", this.mayMark && alarm.kind !== "page" ? "Seen" : "Quiet here");
    button.addEventListener("click", () => this.seen(alarm));
    box.append(button);
    return box;
  },
  names() {
    return this.all.filter((alarm) => !alarm.is_acknowledged).map((alarm) => alarm.kind + alarm.since_s).join();
  },
  seen(alarm) {
    if (alarm.kind === "page" || !this.mayMark || !send({ want: "acknowledge", alarm: alarm.kind })) this.silence();
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
