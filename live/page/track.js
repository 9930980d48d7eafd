// Where the body was: north up, the same scale both ways, contacts by number.
const METRES_A_DEGREE = 111195; // of a sphere of 6,371 km; a chart is not navigated by
function drawTrack(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  if (!width || store.track.length < 2) return;
  const ratio = devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio)) [canvas.width, canvas.height] = [width, height].map((side) => Math.round(side * ratio));
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  const origin = store.track[0];
  const easting = METRES_A_DEGREE * Math.cos((origin.latitude_deg * Math.PI) / 180);
  const plane = (latitude, longitude) => [((longitude - origin.longitude_deg + 540) % 360 - 180) * easting, (latitude - origin.latitude_deg) * METRES_A_DEGREE];
  const way = store.track.map((point) => plane(point.latitude_deg, point.longitude_deg));
  const edges = way.reduce(([w, e, s, n], [x, y]) => [Math.min(w, x), Math.max(e, x), Math.min(s, y), Math.max(n, y)], [Infinity, -Infinity, Infinity, -Infinity]);
  const spread = Math.max(edges[1] - edges[0], 20), rise = Math.max(edges[3] - edges[2], 20);
  const scale = Math.min((width - 40) / spread, (height - 60) / rise);
  const to = ([x, y]) => [width / 2 + (x - (edges[0] + edges[1]) / 2) * scale, height / 2 - 8 - (y - (edges[2] + edges[3]) / 2) * scale];
  ctx.lineWidth = 2;
  ctx.strokeStyle = colour("first");
  ctx.beginPath();
  way.forEach((place, k) => {
    const isGap = k && store.track[k].time_s - store.track[k - 1].time_s > 120;
    ctx[k && !isGap ? "lineTo" : "moveTo"](...to(place));
  });
  ctx.stroke();
  ctx.font = "bold 14px system-ui, sans-serif";
  ctx.fillStyle = ctx.strokeStyle = colour("contact");
  for (const contact of store.contacts.filter((contact) => contact.position_deg)) {
    const [x, y] = to(plane(...contact.position_deg));
    ctx.strokeRect(x - 6, y - 6, 12, 12);
    ctx.fillText(`T${contact.number}`, x + 9, y + 5);
  }
  const [x, y] = to(way[way.length - 1]);
  ctx.fillStyle = ctx.strokeStyle = colour("ink");
  ctx.beginPath();
  ctx.arc(x, y, 7, 0, 7);
  ctx.fill();
  const length = [5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000].find((metres) => metres * scale > 60) ?? 50000;
  ctx.fillRect(12, height - 12, length * scale, 3);
  ctx.fillText(length < 1000 ? `${length} m` : `${length / 1000} km`, 12, height - 18);
  ctx.fillText("N ↑", width - 38, 20);
}
