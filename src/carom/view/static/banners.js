/** What stays at the top of the page as long as it holds: no connection, something that failed. */
import { at, put } from "./dom.js";

export class Banners {
  constructor() {
    /** What does not work, in sentences; "" when all is well. */
    this.failures = { simulation: "", page: "" };
    addEventListener("error", ({ error }) => this.#complain(error));
    addEventListener("unhandledrejection", ({ reason }) => this.#complain(reason));
  }

  /** @param {"connection" | "failure"} id @param {string} sentence */
  say(id, sentence) {
    put(at(id), sentence);
    at(id).hidden = sentence === "";
  }

  /** @param {"simulation" | "page"} what @param {string} sentence */
  fail(what, sentence) {
    this.failures[what] = sentence;
    this.say("failure", Object.values(this.failures).join(" ").trim());
  }

  /** Something in the page itself went wrong. @param {unknown} error */
  #complain(error) {
    // What is no Error comes from the browser and is no fault, such as a late ResizeObserver.
    if (error instanceof Error) {
      this.fail("page", `The page has met an error: ${error.message}. Reload it to begin anew.`);
    }
  }
}
