/** Doing something once instead of many times. */

/**
 * Call `act` with the newest value once `wait` milliseconds have passed without another.
 * @template T @param {(value: T) => void} act @param {number} wait
 */
export function settled(act, wait) {
  let timer = 0;
  return (/** @type {T} */ value) => {
    clearTimeout(timer);
    timer = setTimeout(() => act(value), wait);
  };
}

/**
 * Call `act` at once, then at most every `wait` milliseconds, the newest value last.
 * @template T @param {(value: T) => void} act @param {number} wait
 */
export function spaced(act, wait) {
  /** @type {{value: T} | null} */
  let next = null;
  let waiting = false;
  const go = () => {
    waiting = next !== null;
    if (next === null) return;
    const { value } = next;
    next = null;
    setTimeout(go, wait);
    act(value);
  };
  return (/** @type {T} */ value) => {
    next = { value };
    if (!waiting) go();
  };
}
