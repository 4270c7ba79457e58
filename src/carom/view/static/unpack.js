/** Begins a page that is one file: unpacks its program, which must be the one that the page's policy names. */

async function unpack() {
  const letters = atob(document.getElementById("program")?.textContent ?? "");
  const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const text = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const script = document.createElement("script");
  script.type = "module";
  script.textContent = await new Response(text).text();
  document.body.append(script);
}

unpack().catch((/** @type {Error} */ { message }) => {
  const place = /** @type {HTMLElement} */ (document.getElementById("connection"));
  place.textContent = `This page needs a browser of 2023 or later: ${message}.`;
  place.hidden = false;
});
