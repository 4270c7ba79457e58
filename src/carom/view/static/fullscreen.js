/** The page on the whole screen. */
import { toast } from "./toast.js";

export async function toggleFullScreen() {
  try {
    if (document.fullscreenElement !== null) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen();
  } catch {
    toast("This browser does not let the page fill the screen.");
  }
}

/** @param {HTMLElement} button pressed while the page fills the screen */
export function watchFullScreen(button) {
  document.addEventListener("fullscreenchange", () => {
    button.setAttribute("aria-pressed", String(document.fullscreenElement !== null));
  });
}
