// Puts the plots on the page, if the page has not done so itself.
async () => {
  if (carom.plots) return;
  const { Plots } = await import("/plots.js");
  const sheet = document.createElement("link");
  const loaded = new Promise((done) => sheet.addEventListener("load", done));
  Object.assign(sheet, { rel: "stylesheet", href: "/plots.css" });
  document.head.append(sheet);
  const box = document.createElement("section");
  box.id = "plots";
  const style = {
    position: "fixed", top: "0", left: "0", width: "min(268px, 100%)", "max-height": "100%",
    overflow: "auto", padding: "18px", background: "var(--back)",
  };
  for (const [name, value] of Object.entries(style)) box.style.setProperty(name, value);
  document.body.append(box);
  await loaded;
  const plots = new Plots(box);
  carom.plots = plots;
  let scene = carom.scene;
  plots.setScene(scene);
  const push = carom.readout.push.bind(carom.readout);
  carom.readout.push = (frame) => {
    push(frame);
    if (scene !== carom.scene) plots.setScene((scene = carom.scene));
    plots.push(frame, matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
  };
  const loop = (now) => {
    plots.show(now);
    requestAnimationFrame(loop);
  };
  requestAnimationFrame(loop);
}
