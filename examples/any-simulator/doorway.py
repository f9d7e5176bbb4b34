#!/usr/bin/env python3
"""Ten robots walk from the left room of a 4 x 2 m arena through a doorway into the right one.

usage: doorway.py CASE OUT SEED SPEED BOTH_SIDES

CASE: obstacles as JSON. OUT: where the numbers go, as one JSON object. trajectory.csv: where the robots were.
A robot walks towards its goal. What stands in its way it passes on its left, and here is the fault: without
BOTH_SIDES it never tries its right, so that it waits for ever where only the right is free.
"""
import json
import math
import random
import sys

RADIUS, TICK, LIMIT = 0.05, 0.2, 40.0  # m, s, s
DOOR = 2.0, 1.0  # m: the middle of the doorway
# x, y, length, width (m) and degrees, counter-clockwise: the wall between the rooms
WALLS = [(2.0, 0.3, 0.1, 0.6, 0.0), (2.0, 1.7, 0.1, 0.6, 0.0)]


def blocked(x, y, boxes):
    if not (RADIUS < x < 4 - RADIUS and RADIUS < y < 2 - RADIUS):
        return True
    for bx, by, length, width, cosine, sine in boxes:
        dx, dy = x - bx, y - by
        along = abs(dx * cosine + dy * sine) - length / 2
        across = abs(dy * cosine - dx * sine) - width / 2
        if math.hypot(max(along, 0), max(across, 0)) < RADIUS:
            return True
    return False


class Robot:
    def __init__(self, rng, boxes):
        self.x = self.y = 0.0
        while blocked(self.x, self.y, boxes):
            self.x, self.y = rng.uniform(0.1, 0.7), rng.uniform(0.2, 1.8)
        self.heading, self.side = 0.0, math.pi / 2

    def arrived(self):
        return self.x > 3.3

    def step(self, rng, boxes, speed, both_sides):
        aim = DOOR if self.x < DOOR[0] - 0.1 and abs(self.y - DOOR[1]) > 0.3 else (3.9, DOOR[1])
        ahead = math.atan2(aim[1] - self.y, aim[0] - self.x) + rng.gauss(0, 0.1)
        for turn in (0.0, self.side / 2, self.side):
            x = self.x + speed * TICK * math.cos(ahead + turn)
            y = self.y + speed * TICK * math.sin(ahead + turn)
            if not blocked(x, y, boxes):
                self.x, self.y, self.heading = x, y, ahead + turn
                return
        if both_sides:
            self.side = -self.side


def main(case, out, seed, speed, both_sides):
    with open(case) as file:
        genes = json.load(file).get("obstacles", [])
    boxes = [(x, y, l, w, math.cos(math.radians(d)), math.sin(math.radians(d))) for x, y, l, w, d in WALLS + [
        (g["x"], g["y"], g["length"], g["width"], g.get("orientation_deg", 0.0)) for g in genes]]
    rng = random.Random(int(seed))
    robots = [Robot(rng, boxes) for _ in range(10)]
    time = 0.0
    with open("trajectory.csv", "w") as file:
        file.write("time,robot,kind,x,y,heading\n")
        while time <= LIMIT and not all(robot.arrived() for robot in robots):
            if round(time / TICK) % 5 == 0:
                for number, robot in enumerate(robots):
                    file.write(f"{time:.1f},{number},robot,{robot.x:.4f},{robot.y:.4f},{robot.heading:.4f}\n")
            for robot in robots:
                if not robot.arrived():
                    robot.step(rng, boxes, float(speed), float(both_sides) != 0)
            time += TICK
    left = [robot for robot in robots if not robot.arrived()] or robots
    with open(out, "w") as file:
        json.dump({"arrived": sum(robot.arrived() for robot in robots), "time": round(time, 1),
                   "left_x": sum(r.x for r in left) / len(left), "left_y": sum(r.y for r in left) / len(left)}, file)


main(*sys.argv[1:])
