/**
 * How the canvas is shared out: which part panels cover, and where the pictures go.
 * @typedef {import("./split.js").Viewport} Viewport
 * @typedef {{viewports: Viewport[], size: {width: number, height: number},
 *   insets: import("./camera.js").Insets}} Layout
 */
import { halves } from "./split.js";

const ROOMY = 600; // pixels in which two halves fit side by side on a narrow page
const MARGIN = 8; // pixels between a picture and what covers it

/**
 * @param {object} page all in pixels
 * @param {number} page.width of the canvas
 * @param {number} page.height
 * @param {number} page.right where the panel begins, or the width
 * @param {number} page.bottom where the bar or the sheet begins
 * @param {number} page.top where the heading ends
 * @param {number} page.labels height of the labels of the split screen; 0 if it is not split
 * @param {boolean} page.narrow
 * @returns {Layout}
 */
export function layout({ width, height, right, bottom, top, labels, narrow }) {
  if (labels > 0) {
    // Only the free area is split, so that both sides show the same.
    const end = Math.max(top + 120, bottom - MARGIN);
    const viewports = narrow
      ? halves(right, top, end, right < Math.max(ROOMY, end - top))
      : halves(right, 0, height, false);
    const insets = narrow
      ? { left: 0, right: 0, top: labels, bottom: 0 }
      : { left: 0, right: 0, top: top + labels, bottom: height - bottom + MARGIN };
    const { width: w, height: h } = viewports[0];
    return { viewports, size: { width: w, height: h }, insets };
  }
  return {
    viewports: [{ x: 0, y: 0, width, height }],
    size: { width, height },
    insets: { left: 0, right: width - right, top: narrow ? top : 0, bottom: height - bottom },
  };
}
