// Mouse, touch and keys become turns, moves and choices.

const TURN = 0.006, STEP = Math.PI / 24, NEARER = 1.15, CLICK = 4;

export function listen(canvas, whole, act) {
  const pointers = new Map();
  let travelled = 0;

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button > 2) return;
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (pointers.size === 1) travelled = 0;
    else travelled = Infinity;  // no click
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(last.x - other.x, last.y - other.y);
      const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
      const middle = act.place(0.5 * (event.clientX + other.x), 0.5 * (event.clientY + other.y));
      act.pan(0.5 * dx, 0.5 * dy);
      if (before > 0 && after > 0) act.zoom(after / before, middle);
    } else if (pointers.size === 1) {
      travelled += Math.abs(dx) + Math.abs(dy);
      if (travelled > CLICK) {
        if (event.shiftKey || event.buttons & 6 || act.flat) act.pan(dx, dy);
        else act.turn(-TURN * dx, TURN * dy);
      }
    }
    last.x = event.clientX;
    last.y = event.clientY;
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    if (event.type === "pointerup" && event.button === 0 && travelled <= CLICK) act.click(event);
    act.rest();
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  // In a page that scrolls the wheel is the page's until the view has been clicked.
  canvas.addEventListener("wheel", (event) => {
    if (!whole && document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    act.zoom(Math.exp(-0.0015 * lines * event.deltaY), act.place(event.clientX, event.clientY));
    act.rest();
  }, { passive: false });

  const keys = {
    "+": () => act.zoom(NEARER), "=": () => act.zoom(NEARER), "-": () => act.zoom(1 / NEARER),
    "0": act.reset, Home: act.reset, m: act.nextColour, c: act.nextCut, f: act.flip, "[": () => act.moveCut(-0.02),
    "]": () => act.moveCut(0.02), i: () => act.toggle("images"), w: () => act.toggle("walls"),
    o: () => act.toggle("lines"), p: act.picture, e: act.wholeScreen, "?": act.keys, Escape: act.escape,
    x: () => act.lookAlong(0), y: () => act.lookAlong(1), z: () => act.lookAlong(2),
  };
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = arrows[event.key];
    if (arrow && (event.shiftKey || act.flat)) act.pan(-32 * arrow[0], -32 * arrow[1]);
    else if (arrow) act.turn(STEP * arrow[0], -STEP * arrow[1]);
    else if (keys[event.key]) keys[event.key]();
    else return;
    event.preventDefault();
    act.rest();
  });
}
