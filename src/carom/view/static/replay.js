/** The page of a replay: a file that holds all it shows. */
import { Film } from "./film.js";
import { Page } from "./page.js";
import { decodeReel } from "./reel.js";
import { Scrub } from "./scrub.js";
import { startPage } from "./start.js";

/** The bytes in the page's element for data. */
function data() {
  const text = atob(document.getElementById("data")?.textContent ?? "");
  return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
}

void startPage(async () => {
  const film = new Film(await decodeReel(data()));
  const scrub = new Scrub(film);
  const actions = { earlier: () => film.shift(-1), later: () => film.shift(1) };
  const page = new Page({ mode: "replay", timeline: film, connect: (listener) => film.attach(listener), actions });
  scrub.show();
  return page;
});
