"""Phase 2 of the paper: two balls of equal mass collide in a cube, and it prints what happens."""

from carom.scenes import phase_2_lines
from carom.sketch import *

WIDTH, RADIUS = 500, 50
FREE = WIDTH / 2 - RADIUS  # how far from the middle a centre may be


class Ball:
    def __init__(self, x, y, z):
        self.location = Vector(x, y, z)
        self.velocity = Vector(random(-10, 10), random(-10, 10), random(-20, 20))
        self.color = color(random(360), 90, random(75, 100))

    def energy(self):
        return self.velocity.dot(self.velocity) / 2

    def move(self):
        self.location = self.location.add(self.velocity)
        axes = zip(self.location, self.velocity)  # a ball that leaves on one axis turns round
        self.velocity = Vector(*(-v if abs(x) > FREE and x * v > 0 else v for x, v in axes))

    def display(self):
        push_matrix()
        translate(*self.location)
        stroke(self.color)
        sphere(RADIUS)
        pop_matrix()


def setup():
    global a, b, collided, collisions
    size(900, 700)
    color_mode("hsb", 360, 100, 100)
    no_fill()
    a, b = Ball(0, 0, -150), Ball(0, 0, 150)
    collided, collisions = False, 0


def draw():
    global collided, collisions
    background(220, 35, 12)
    translate(width() / 2, height() / 2, -280)
    rotate_x(-0.2)
    rotate_y(0.5)
    stroke(145, 80, 75)
    box(WIDTH)
    for ball in (a, b):
        ball.move()
        ball.display()
    touching = a.location.dist(b.location) < 2 * RADIUS
    if touching and not collided:  # once for each contact, not for each tick of it
        n = a.location.sub(b.location).normalize()
        psi = a.velocity.sub(b.velocity).dot(n)
        a.velocity = a.velocity.sub(n.mult(psi))
        b.velocity = b.velocity.add(n.mult(psi))
        collisions += 1
        print(phase_2_lines(collisions, tuple(n), psi, (a.energy(), b.energy())))
    collided = touching
