"""Phase 1 of the paper: balls in a cube. They bounce off its walls and pass through each other."""

from carom.sketch import *

WIDTH = 500  # side of the cube
RADIUS = 50
FREE = WIDTH / 2 - RADIUS  # how far from the middle a ball's centre may be


class Ball:
    def __init__(self):
        self.location = Vector(0, 0, 0)
        self.velocity = Vector(random(-10, 10), random(-10, 10), random(-20, 20))
        self.color = color(random(360), 90, random(75, 100))

    def move(self):
        self.location = self.location.add(self.velocity)
        x, y, z = self.location
        vx, vy, vz = self.velocity
        if abs(x) > FREE:  # each axis on its own
            vx = -vx
        if abs(y) > FREE:
            vy = -vy
        if abs(z) > FREE:
            vz = -vz
        self.velocity = Vector(vx, vy, vz)

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
    translate(width() / 2, height() / 2, -280)
    rotate_x(-0.2)
    rotate_y(0.5)
    stroke(145, 80, 75)
    box(WIDTH)
    for ball in balls:
        ball.move()
        ball.display()
