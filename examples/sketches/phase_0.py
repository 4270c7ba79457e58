"""Phase 0 of the paper: balls in a sphere. At the wall a ball turns round."""

from carom.sketch import *

WIDTH = 500  # radius of the large sphere
RADIUS = 50


class Ball:
    def __init__(self):
        self.location = Vector(0, 0, 0)
        self.velocity = Vector(random(-10, 10), random(-10, 10), random(-20, 20))
        self.color = color(random(360), 90, random(75, 100))

    def move(self):
        self.location = self.location.add(self.velocity)
        if self.location.mag() + RADIUS > WIDTH:
            self.velocity = self.velocity.mult(-1)  # the way it came, not a reflection

    def display(self):
        push_matrix()
        translate(*self.location)
        stroke(self.color)
        sphere(RADIUS)
        pop_matrix()


def setup():
    global balls
    size(900, 700)
    color_mode("hsb", 360, 100, 100)
    no_fill()
    balls = [Ball() for _ in range(12)]


def draw():
    background(220, 35, 12)
    translate(width() / 2, height() / 2, -WIDTH)
    stroke(145, 80, 75)
    sphere_detail(36)
    sphere(WIDTH)
    sphere_detail(24)
    for ball in balls:
        ball.move()
        ball.display()
