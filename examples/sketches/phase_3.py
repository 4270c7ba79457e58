"""Phase 3 of the paper: many equal balls. A set remembers the pairs that touch."""

from carom.sketch import *

WIDTH, RADIUS = 500, 50
FREE = WIDTH / 2 - RADIUS  # how far from the middle a centre may be


class Ball:
    def __init__(self, x, y, z):
        self.location = Vector(x, y, z)
        self.velocity = Vector(random(-10, 10), random(-10, 10), random(-20, 20))
        self.color = color(random(360), 90, random(75, 100))

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
    global balls, active
    size(900, 700)
    color_mode("hsb", 360, 100, 100)
    no_fill()
    balls = [Ball(x, y, z) for x in (-120, 120) for y in (-120, 120) for z in (-160, 0, 160)]
    active = set()


def collide(a, b):
    n = a.location.sub(b.location).normalize()
    psi = a.velocity.sub(b.velocity).dot(n)
    a.velocity = a.velocity.sub(n.mult(psi))
    b.velocity = b.velocity.add(n.mult(psi))


def draw():
    background(220, 35, 12)
    translate(width() / 2, height() / 2, -280)
    rotate_x(-0.2)
    rotate_y(0.5)
    stroke(145, 80, 75)
    box(WIDTH)
    for i, a in enumerate(balls):
        a.move()
        a.display()
        for b in balls[:i]:
            if a.location.dist(b.location) > 2 * RADIUS:
                active.discard((a, b))
            elif (a, b) not in active:  # they begin to touch
                active.add((a, b))
                collide(a, b)
