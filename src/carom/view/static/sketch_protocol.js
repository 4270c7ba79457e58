/**
 * A sketch's frame, as `carom/sketch/message.py` describes it.
 *
 * @typedef {object} Sheet
 * @property {number} n number of shapes
 * @property {number} epoch counts restarts
 * @property {boolean} playing
 * @property {boolean} failed
 * @property {number} width of the sheet, in its own pixels
 * @property {number} height
 * @property {[number, number, number]} background parts from 0 to 1
 * @property {number} frame how often draw() has run
 * @property {number} rate frames per second asked for
 * @property {number} reached frames per second reached
 * @property {Float32Array} numbers the shapes, SHAPE_WORDS each: 0 … 11 the matrix
 * @property {Uint32Array} words the same memory: 12 fill, 13 stroke, 15 kind and detail
 */
import {
  AT,
  FAILED,
  MAGIC,
  PLAYING,
  SCENE_HEADER_BYTES,
  SKETCH,
  VERSION,
} from "./wire.js";

export const BOX = 1;
export const LINE = 2;
export const SHAPE_WORDS = 16;
export const FILL = 12;
export const STROKE = 13;
export const KIND = 15;

const SHEET_BYTES = 24;
const SHAPES = SCENE_HEADER_BYTES + SHEET_BYTES;

/**
 * @param {ArrayBuffer} buffer
 * @returns {{kind: "frame", frame: Sheet, moving: boolean}} moving: whether a long silence is a sign
 *   that the line is dead; a sketch may be slow, or draw only once
 */
export function decodeSketch(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < SCENE_HEADER_BYTES || view.getUint32(AT.magic, true) !== MAGIC) {
    throw new Error("this is no message of carom");
  }
  const version = view.getUint16(AT.version, true);
  const kind = view.getUint16(AT.kind, true);
  if (version !== VERSION) {
    throw new Error(`the server speaks version ${version}, this page ${VERSION}`);
  }
  if (kind !== SKETCH) throw new Error(`a message of kind ${kind} is no sketch`);
  const n = view.getUint32(AT.n, true);
  if (buffer.byteLength !== SHAPES + 4 * SHAPE_WORDS * n) {
    throw new Error(`a sketch of ${n} shapes has ${buffer.byteLength} bytes`);
  }
  const flags = view.getUint32(AT.flags, true);
  const whole = (/** @type {number} */ place) =>
    view.getUint32(SCENE_HEADER_BYTES + 4 * place, true);
  const color = whole(2);
  const frame = {
    n,
    epoch: view.getUint32(AT.epoch, true),
    playing: (flags & PLAYING) !== 0,
    failed: (flags & FAILED) !== 0,
    width: whole(0),
    height: whole(1),
    background: /** @type {[number, number, number]} */ ([
      (color & 255) / 255,
      ((color >> 8) & 255) / 255,
      ((color >> 16) & 255) / 255,
    ]),
    frame: whole(3),
    rate: view.getFloat32(SCENE_HEADER_BYTES + 16, true),
    reached: view.getFloat32(SCENE_HEADER_BYTES + 20, true),
    numbers: new Float32Array(buffer, SHAPES, SHAPE_WORDS * n),
    words: new Uint32Array(buffer, SHAPES, SHAPE_WORDS * n),
  };
  return { kind: "frame", frame, moving: false };
}
