// The connection to the server: made again whenever it is lost, and the gap filled.
const LOST_S = 5; // a wireless network that hands a tablet on takes two or three
const link = { socket: null, session: null, may: { mark: false, command: false }, isLive: true, isOver: false, closed: null, wait: 500, heard: 0, reconnects: 0, lostAsked: 0 };
function send(wish) {
  if (link.socket?.readyState !== WebSocket.OPEN) return false;
  link.socket.send(JSON.stringify(wish));
  return true;
}
function askHistory(since) {
  send({ want: "history", window_s: store.window, since_s: since });
}
const take = {
  hello(told) {
    const isNew = link.session != null && link.session !== told.session;
    // A recording that is shown again from its start: what is here is of another time.
    if (isNew && told.now_s != null && store.last != null && told.now_s < store.last - 5) store.clear();
    Object.assign(link, { session: told.session, isLive: told.is_live, isOver: told.is_over, may: { mark: told.may_mark, command: told.may_command } });
    told.marks.forEach((mark) => store.add(store.marks, mark));
    told.contacts.forEach((contact) => store.add(store.contacts, contact));
    store.texts = told.texts;
    showHello(told);
    showLamps(told.lamps);
    alarms.show(told.alarms, link.may.mark);
    showLists();
    askHistory(store.time.length ? store.last : null);
  },
  epochs(told) {
    told.rows.forEach((row) => store.row(row));
    store.trim();
    redraw(true);
  },
  history(told) {
    store.history(told);
    redraw(false);
  },
  lamps: (told) => showLamps(told.lamps),
  alarms: (told) => alarms.show(told.alarms, link.may.mark),
  mark(told) {
    if (store.add(store.marks, told.mark)) showLists();
    redraw(false);
  },
  contact(told) {
    if (store.add(store.contacts, told.contact)) showLists();
    redraw(false);
  },
  text(told) {
    store.texts.push(told.text);
    if (store.texts.length > 100) store.texts.shift();
    showLists();
  },
  refused: (told) => take.text(told),
  // This screen was too slow. Not at once for each: it is slow already.
  lost() {
    clearTimeout(link.lostAsked);
    link.lostAsked = setTimeout(() => askHistory(null), 1000);
  },
  end() {
    link.isOver = true;
    showLink();
  },
};
function connect() {
  const socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}/live${location.search}`);
  link.socket = socket;
  socket.addEventListener("open", () => { Object.assign(link, { wait: 500, closed: null }); link.reconnects += 1; showLink(); });
  socket.addEventListener("message", (event) => {
    link.heard = Date.now();
    const told = JSON.parse(event.data);
    take[told.kind]?.(told);
  });
  socket.addEventListener("close", () => {
    if (link.socket !== socket) return;
    link.socket = null;
    link.closed ??= Date.now() / 1000;
    showLink();
    setTimeout(connect, link.wait);
    link.wait = Math.min(2 * link.wait, 4000);
  });
}
function showLink() {
  const box = at("link");
  const isOpen = link.socket?.readyState === WebSocket.OPEN;
  // The server sends a sign of life of its own only on the wire; epochs are ten a second.
  const age = store.sent != null && link.isLive ? Date.now() / 1000 - store.sent : null;
  const delay = age != null && Math.abs(age) < 60 ? `, ${number(Math.max(age, 0), 1)} s behind` : "";
  const text = !isOpen ? "NO CONNECTION: trying again" : link.isOver ? "The end of the recording" : `${link.isLive ? "live" : "recording"}${delay}${link.may.mark ? "" : ", looking only"}`;
  if (box.textContent !== text) box.textContent = text;
  box.className = isOpen ? "" : "bad";
  const isWatched = link.isLive && !link.isOver;
  alarms.lost(isWatched && link.closed != null && Date.now() / 1000 - link.closed > LOST_S ? link.closed : null);
  // A lamp that is green, and has not been asked for a while, is the worst that a page can show.
  const isSilent = alarms.told.some((alarm) => alarm.kind === "cable" && !alarm.is_over);
  showStale(isWatched && (!isOpen || isSilent));
}
