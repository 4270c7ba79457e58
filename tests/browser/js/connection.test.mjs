// The line to the server: what it says, when it calls again, and what it takes for a dead line.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { MAX_CREDITS, SOCKET_PATH, VERSION, WRONG_TOKEN } = await import(`${folder}wire.js`);

let clock = 0; // milliseconds
let timers = []; // {id, at, act}
let signs = []; // what the page listens to: [name, act]
let sockets = [];

class FakeSocket {
  static OPEN = 1;

  constructor(address) {
    this.address = address;
    this.readyState = 0;
    this.said = [];
    this.closed = false;
    sockets.push(this);
  }

  send(text) {
    assert.equal(this.readyState, 1, "nothing is sent on a line that is not open");
    this.said.push(JSON.parse(text));
  }

  close() {
    this.readyState = 2;
    this.closed = true;
  }

  open() {
    this.readyState = 1;
    this.onopen();
  }

  /** The server ends the line, or was never there. */
  end(code = 1006, reason = "") {
    this.readyState = 3;
    this.onclose?.({ code, reason });
  }

  hear(data) {
    this.onmessage?.({ data });
  }
}

/** Let time pass, and timers ring. */
function pass(milliseconds) {
  const end = clock + milliseconds;
  for (;;) {
    const next = timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at)[0];
    if (next === undefined) break;
    timers = timers.filter((each) => each !== next);
    clock = Math.max(clock, next.at);
    next.act();
  }
  clock = end;
}

const fake = (name, value) => Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
let ids = 0;
fake("WebSocket", FakeSocket);
fake("performance", { now: () => clock });
fake("location", { host: "127.0.0.1:8000", hash: "", pathname: "/" });
fake("document", { hidden: false });
fake("addEventListener", (name, act) => signs.push([name, act]));
fake("setTimeout", (act, ms) => {
  timers.push({ id: ++ids, at: clock + ms, act });
  return ids;
});
fake("clearTimeout", (id) => (timers = timers.filter((each) => each.id !== id)));

const { Connection, takeToken } = await import(`${folder}connection.js`);

beforeEach(() => {
  [timers, signs, sockets] = [[], [], []];
  document.hidden = false;
});

/** A page's connection; messages are objects as `decode` would make them. */
function connect() {
  const heard = [];
  const states = [];
  const line = new Connection(
    "token",
    {
      scene: (scene) => heard.push(scene),
      frame: (frame) => heard.push(frame),
      note: (key, value) => heard.push([key, value]),
      state: (state, sentence) => states.push([state, sentence]),
    },
    (message) => message,
  );
  return { line, heard, states };
}

const frame = (more = {}) => ({ kind: "frame", frame: { playing: true, twin: false, ...more } });

/** A connection on which the scene plays. */
function playing() {
  const all = connect();
  sockets[0].open();
  sockets[0].hear(frame());
  all.line.returnCredit();
  sockets[0].said = [];
  return all;
}

/** Draw so many pictures, so many milliseconds apart. */
function draw(line, pictures, apart) {
  for (let k = 0; k < pictures; k++) {
    pass(apart);
    line.returnCredit();
  }
}

const wake = (name) => signs.filter(([sign]) => sign === name).forEach(([, act]) => act());

test("it says who it is, then how much it takes, and hands over what comes", () => {
  const { line, heard, states } = connect();
  const [socket] = sockets;
  assert.equal(socket.address, `ws://127.0.0.1:8000${SOCKET_PATH}`);
  assert.equal(socket.binaryType, "arraybuffer");
  line.send("too early");
  socket.open();
  assert.deepEqual(socket.said, [
    { op: "hello", token: "token", version: VERSION },
    { op: "credit", count: 2 },
  ]);
  assert.deepEqual(states, []); // an open line is no answer yet
  socket.hear('{"role":"control"}');
  socket.hear({ kind: "scene", scene: { number: 3 } });
  socket.hear(frame({ t: 1 }));
  assert.deepEqual(heard, [["role", "control"], { number: 3 }, { playing: true, twin: false, t: 1 }]);
  assert.deepEqual(states, [["open", ""]]);
  line.send('{"op":"play"}');
  assert.deepEqual(socket.said.at(-1), { op: "play" });
});

test("credit goes back once per picture, for as many frames as came, twins not counted", () => {
  const { line } = playing();
  const [socket] = sockets;
  line.returnCredit();
  assert.deepEqual(socket.said, []); // nothing came
  socket.hear(frame());
  socket.hear(frame({ twin: true }));
  assert.deepEqual(socket.said, []); // not before it is drawn
  line.returnCredit();
  line.returnCredit();
  assert.deepEqual(socket.said, [{ op: "credit", count: 1 }]);
  for (let k = 0; k < MAX_CREDITS + 3; k++) socket.hear(frame());
  line.returnCredit();
  assert.deepEqual(socket.said.at(-1), { op: "credit", count: MAX_CREDITS });
});

test("a line that was cut is called again, more and more patiently, and begins anew", () => {
  const { states } = playing();
  for (const wait of [250, 500, 1000, 2000, 2000]) {
    const before = sockets.length;
    sockets.at(-1).end();
    assert.equal(states.at(-1)[0], "waiting");
    pass(wait - 1);
    assert.equal(sockets.length, before);
    pass(1);
    assert.equal(sockets.length, before + 1);
  }
  const socket = sockets.at(-1);
  socket.open();
  assert.deepEqual(socket.said.map(({ op }) => op), ["hello", "credit"]);
  socket.hear(frame());
  assert.deepEqual(states.at(-1), ["open", ""]);
  socket.end(1001, "going away");
  assert.match(states.at(-1)[1], /going away/);
  pass(250);
  assert.equal(sockets.length, 7); // patience begins anew too
});

test("frames of a line that was cut give no credit to the next", () => {
  const { line } = playing();
  sockets[0].hear(frame());
  sockets[0].end();
  pass(250);
  sockets[1].open();
  line.returnCredit();
  assert.deepEqual(sockets[1].said.map(({ op, count }) => [op, count]), [["hello", undefined], ["credit", 2]]);
});

test("a wrong token ends all calls, whatever wakes up", () => {
  const { states } = connect();
  sockets[0].open();
  sockets[0].end(WRONG_TOKEN, "this page belongs to another run");
  assert.equal(states.at(-1)[0], "refused");
  for (const sign of ["online", "pageshow", "visibilitychange"]) wake(sign);
  pass(600_000);
  assert.equal(sockets.length, 1);
  assert.deepEqual(timers, []);
});

test("a line that is silent while time runs is hung up, and called again", () => {
  const { line, heard, states } = playing();
  draw(line, 920, 16); // 14.7 seconds
  assert.equal(sockets[0].closed, false);
  draw(line, 30, 16);
  assert.equal(sockets[0].closed, true);
  assert.equal(states.at(-1)[0], "waiting");
  const before = heard.length;
  sockets[0].hear(frame()); // too late: it was given up
  sockets[0].end();
  assert.equal(heard.length, before);
  pass(250);
  assert.equal(sockets.length, 2);
  draw(line, 10, 16);
  assert.equal(sockets.length, 2);
});

test("a page that pauses may be silent for ever", () => {
  const { line } = playing();
  sockets[0].hear(frame({ playing: false }));
  draw(line, 4000, 16);
  assert.equal(sockets.length, 1);
  assert.equal(sockets[0].closed, false);
});

test("a page that was busy, hidden or asleep has heard nothing: that is no dead line", () => {
  const { line } = playing();
  pass(3_600_000); // an hour without a picture
  line.returnCredit();
  draw(line, 100, 2000); // very slow pictures: three minutes, of which ten seconds count
  assert.equal(sockets[0].closed, false);
  sockets[0].hear(frame()); // every word is a sign of life
  draw(line, 100, 2000);
  assert.equal(sockets[0].closed, false);
  draw(line, 60, 2000);
  assert.equal(sockets[0].closed, true);
});

test("a call that nobody answers is given up", () => {
  const { states } = connect();
  pass(14_999);
  assert.equal(sockets[0].closed, false);
  pass(1);
  assert.equal(sockets[0].closed, true);
  assert.equal(states.at(-1)[0], "waiting");
  pass(250);
  sockets[1].open();
  sockets[1].hear('{"role":"control"}');
  pass(600_000); // answered: that clock has stopped
  assert.equal(sockets.length, 2);
  assert.equal(sockets[1].closed, false);
});

test("who wakes up calls at once, but only one line at a time, and not in the dark", () => {
  playing();
  for (const sign of ["online", "pageshow", "visibilitychange"]) {
    const before = sockets.length;
    wake(sign); // the line is there
    assert.equal(sockets.length, before);
    sockets.at(-1).end();
    document.hidden = true;
    wake(sign);
    assert.equal(sockets.length, before);
    document.hidden = false;
    wake(sign);
    wake(sign); // this call is on its way
    assert.equal(sockets.length, before + 1);
    sockets.at(-1).open();
    sockets.at(-1).hear('{"role":"control"}');
    pass(10_000); // the call that was waited for is not made as well
    assert.equal(sockets.length, before + 1);
  }
});

test("the token leaves the address and stays in the tab", () => {
  const stored = new Map();
  const shown = [];
  fake("sessionStorage", { setItem: (key, value) => stored.set(key, value), getItem: (key) => stored.get(key) ?? null });
  fake("history", { replaceState: (_state, _title, address) => shown.push(address) });
  assert.equal(takeToken(), "");
  location.hash = "#token=abc&scene=gas";
  assert.equal(takeToken(), "abc");
  assert.deepEqual(shown, ["/"]);
  location.hash = "";
  assert.equal(takeToken(), "abc");
  const forbidden = () => {
    throw new Error("this browser stores nothing");
  };
  fake("sessionStorage", { setItem: forbidden, getItem: forbidden });
  location.hash = "#token=abc";
  assert.equal(takeToken(), "abc");
  location.hash = "";
  assert.equal(takeToken(), "");
});
