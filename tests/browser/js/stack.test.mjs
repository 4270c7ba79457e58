// The matrix stack: order of operations, turning senses, push and pop.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

const folder = `${pathToFileURL(process.env.CAROM_STATIC).href}/`;
const { MatrixStack, product } = await import(`${folder}stack.js`);

const close = (a, b, error = 1e-6) =>
  b.forEach((value, k) => assert.ok(Math.abs(a[k] - value) <= error, `${a} is not ${b}`));

test("the last operation reaches a point first", () => {
  const stack = new MatrixStack();
  stack.translate(1, 2, 3);
  stack.rotate(Math.PI / 2, 0, 0, 1);
  stack.scale(2);
  close(stack.apply([1, 0, 0]), [1, 4, 3]); // scaled to (2, 0, 0), turned to (0, 2, 0), moved
});

test("turns are counterclockwise about any axis, whatever its length", () => {
  for (const [axis, from, to] of [
    [[0, 0, 5], [1, 0, 0], [0, 1, 0]],
    [[0.1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[0, 2, 0], [0, 0, 1], [1, 0, 0]],
    [[1, 1, 1], [1, 2, 3], null],
  ]) {
    const stack = new MatrixStack();
    stack.rotate(to ? Math.PI / 2 : (2 * Math.PI) / 3, ...axis);
    close(stack.apply(from), to ?? [3, 1, 2]);
  }
});

test("turning back and forth leaves nothing", () => {
  const stack = new MatrixStack();
  stack.rotate(0.7, 1, -2, 0.5);
  stack.rotate(-0.7, 1, -2, 0.5);
  close(stack.apply([3, 4, 5]), [3, 4, 5]);
});

test("each axis has its own scale", () => {
  const stack = new MatrixStack();
  stack.scale(2, 3, 4);
  close(stack.apply([1, 1, 1]), [2, 3, 4]);
});

test("pop comes back to where push was, on several levels", () => {
  const stack = new MatrixStack();
  stack.translate(1, 0, 0);
  stack.push();
  stack.translate(0, 1, 0);
  stack.push();
  stack.scale(5);
  assert.equal(stack.depth, 2);
  stack.pop();
  close(stack.apply([0, 0, 0]), [1, 1, 0]);
  stack.pop();
  close(stack.apply([0, 0, 0]), [1, 0, 0]);
  assert.throws(() => stack.pop(), /pop without push/);
});

test("an axis without direction is refused", () => {
  assert.throws(() => new MatrixStack().rotate(1, 0, 0, 0), /no direction/);
});

test("a product acts as one after the other", () => {
  const [a, b] = [new MatrixStack(), new MatrixStack()];
  a.rotate(0.3, 1, 0, 0);
  b.translate(1, 2, 3);
  const both = new MatrixStack();
  both.multiply(product(a.top, b.top));
  close(both.apply([4, 5, 6]), a.apply(b.apply([4, 5, 6])));
});
