// Puts the plots on the page, where the page has not done so itself.
async () => {
  if (carom.plots) return "mounted";
  const { Plots } = await import("/plots.js");
  const sheet = document.createElement("link");
  Object.assign(sheet, { rel: "stylesheet", href: "/plots.css" });
  document.head.append(sheet);
  const box = document.createElement("section");
  box.id = "plots";
  for (const [name, value] of [["position", "fixed"], ["top", "0"], ["left", "0"], ["width", "268px"], ["max-height", "100%"], ["overflow", "auto"], ["padding", "18px"], ["background", "var(--card)"]]) box.style.setProperty(name, value);
  document.body.append(box);
  const plots = new Plots(box);
  carom.plots = plots;
  // Version 1 of the wire has neither momentum nor temperature nor names.
  const about = (scene) => {
    const a = scene.about;
    a.key ??= 1;
    a.free_axes ??= a.walls.length ? 0 : 3;
    a.walls.forEach((wall, k) => (wall.name ??= ["x−", "x+", "y−", "y+", "z−", "z+"][k]));
    return scene;
  };
  const more = (frame) => {
    if (frame.momentum) return frame;
    const { mass } = carom.scene;
    frame.momentum = [0, 1, 2].map((k) => mass.reduce((sum, m, i) => sum + (m < Infinity ? m * frame.velocity[3 * i + k] : 0), 0));
    frame.temperature = (2 * frame.kinetic) / (3 * frame.n - carom.scene.about.free_axes);
    return frame;
  };
  let scene = carom.scene;
  plots.setScene(about(scene));
  const push = carom.readout.push.bind(carom.readout);
  carom.readout.push = (frame) => {
    if (scene !== carom.scene) plots.setScene(about((scene = carom.scene)));
    push(frame);
    plots.push(more(frame), matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
  };
  const loop = (now) => {
    plots.show(now);
    requestAnimationFrame(loop);
  };
  requestAnimationFrame(loop);
  return "injected";
}
