"""Phase 4 of the paper: balls of different size and mass. Saturation shows their energy."""

from carom.sketch import *

WIDTH = 500


class Ball:
    def __init__(self, x, y, z):
        self.radius, self.hue, self.brightness = random(20, 60), random(360), random(75, 100)
        self.mass = (self.radius / 43) ** 3  # about 1 on average
        self.location = Vector(x, y, z)
        self.velocity = Vector(random(-10, 10), random(-10, 10), random(-20, 20))

    def move(self):
        self.location = self.location.add(self.velocity)
        free = WIDTH / 2 - self.radius  # how far from the middle its centre may be
        axes = zip(self.location, self.velocity)  # a ball that leaves on one axis turns round
        self.velocity = Vector(*(-v if abs(x) > free and x * v > 0 else v for x, v in axes))

    def display(self):
        push_matrix()
        translate(*self.location)
        stroke(self.hue, self.mass * self.velocity.mag() ** 2 / 10, self.brightness)  # KE / 5
        sphere(self.radius)
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
    j = 2 * a.velocity.sub(b.velocity).dot(n) / (1 / a.mass + 1 / b.mass)
    a.velocity = a.velocity.sub(n.mult(j / a.mass))
    b.velocity = b.velocity.add(n.mult(j / b.mass))


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
            if a.location.dist(b.location) > a.radius + b.radius:
                active.discard((a, b))
            elif (a, b) not in active:  # they begin to touch
                active.add((a, b))
                collide(a, b)
