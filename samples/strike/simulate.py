#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""simulate.py SCENE.yaml: rolls the ball of samples/strike.yaml into its pins, and writes that scene with the motion as
keyframes. The same on every machine up to the last digits of its sines.

Rigid bodies with friction: impulses at contacts, solved one after another, again and again, in each of 1,500 steps a
second. A pin is a column of spheres inside its outline and a ring of points at its foot; the ball is a sphere. What
keyframes leave out is interpolated within a millimetre and a degree.
"""
import math
import pathlib
import sys

from make_meshes import BALL_RADIUS, BOARD_HEIGHT, BOARDS, END, GUTTER, INCH, LANE, PIN_HEIGHT, PIT_DEPTH, SIDE, WALL, pin_radius

STEP, ROUNDS, SECONDS = 1 / 1500, 8, 2.4
GRAVITY, BALL_MASS, PIN_MASS = 9.81, 6.8, 1.53
SPACING = 12 * INCH
START_Z, SPEED, START_X, DRIFT = 2.4, 4.6, 0.16, -0.035
FRAME = 1 / 60  # keyframes are thinned from so fine a grid
SLOP = 0.0003


def add(a, b): return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
def sub(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def mul(a, s): return (a[0] * s, a[1] * s, a[2] * s)
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def product(p, q):
    return (p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0])


def turned(q, v):
    u = q[1:]
    t = mul(cross(u, v), 2)
    return add(add(v, mul(t, q[0])), cross(u, t))


def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return tuple(x / length for x in q)


def pin_inertia():
    """Height of the centre of mass, and moments across and along the axis, of a pin of even density."""
    parts, mass, moment = 200, 0.0, 0.0
    slices = [((k + 0.5) / parts * PIN_HEIGHT, pin_radius((k + 0.5) / parts * PIN_HEIGHT)) for k in range(parts)]
    for h, r in slices:
        mass += r * r
        moment += r * r * h
    centre = moment / mass
    across = sum(r * r * (r * r / 4 + (h - centre)**2) for h, r in slices) / mass * PIN_MASS
    along = sum(r**4 / 2 for _, r in slices) / mass * PIN_MASS
    return centre, across, along


PIN_CENTRE, PIN_ACROSS, PIN_ALONG = pin_inertia()


class Body:
    def __init__(self, name, position, mass, across, along, spheres):
        self.name, self.position, self.mass = name, position, mass
        self.turn, self.velocity, self.spin = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        self.across, self.along, self.spheres = across, along, spheres
        self.reach = max(math.sqrt(dot(c, c)) + r for c, r in spheres)
        self.is_ball = len(spheres) == 1
        self.sleeps = not self.is_ball

    def place(self):
        self.axis = turned(self.turn, (0, 1, 0))
        self.world = [(turned(self.turn, c), r) for c, r in self.spheres]

    def inverse_inertia(self, v):
        along = dot(v, self.axis)
        return add(mul(sub(v, mul(self.axis, along)), 1 / self.across), mul(self.axis, along / self.along))

    def velocity_at(self, arm):
        return add(self.velocity, cross(self.spin, arm))

    def push(self, impulse, arm):
        self.velocity = add(self.velocity, mul(impulse, 1 / self.mass))
        self.spin = add(self.spin, self.inverse_inertia(cross(arm, impulse)))


class Contact:
    """`normal` points from b, or from what stands still, to a."""

    def __init__(self, a, b, point, normal, depth, bounce, friction):
        self.a, self.b, self.normal, self.friction = a, b, normal, friction
        self.arm_a = sub(point, a.position)
        self.arm_b = sub(point, b.position) if b else None
        self.normal_impulse, self.slide_impulse = 0.0, (0.0, 0.0)
        side = (1, 0, 0) if abs(normal[0]) < 0.7 else (0, 1, 0)
        t = cross(normal, side)
        self.first = mul(t, 1 / math.sqrt(dot(t, t)))
        self.second = cross(normal, self.first)
        self.masses = [self.mass_along(d) for d in (normal, self.first, self.second)]
        closing = dot(self.relative(), normal)
        self.target = -bounce * closing if closing < -0.15 else 0.0
        self.target = max(self.target, min(0.15 * max(0.0, depth - SLOP) / STEP, 1.5))

    def mass_along(self, d):
        k = 1 / self.a.mass + dot(d, cross(self.a.inverse_inertia(cross(self.arm_a, d)), self.arm_a))
        if self.b:
            k += 1 / self.b.mass + dot(d, cross(self.b.inverse_inertia(cross(self.arm_b, d)), self.arm_b))
        return 1 / k

    def relative(self):
        v = self.a.velocity_at(self.arm_a)
        return sub(v, self.b.velocity_at(self.arm_b)) if self.b else v

    def apply(self, impulse):
        self.a.push(impulse, self.arm_a)
        if self.b:
            self.b.push(mul(impulse, -1), self.arm_b)

    def solve(self):
        change = self.masses[0] * (self.target - dot(self.relative(), self.normal))
        now = max(0.0, self.normal_impulse + change)
        change, self.normal_impulse = now - self.normal_impulse, now
        if change:
            self.apply(mul(self.normal, change))
        v = self.relative()
        slide = [self.slide_impulse[0] - self.masses[1] * dot(v, self.first),
                 self.slide_impulse[1] - self.masses[2] * dot(v, self.second)]
        length, most = math.hypot(*slide), self.friction * self.normal_impulse
        if length > most:
            slide = [s * most / length for s in slide]
        d = (slide[0] - self.slide_impulse[0], slide[1] - self.slide_impulse[1])
        self.slide_impulse = tuple(slide)
        if d != (0, 0):
            self.apply(add(mul(self.first, d[0]), mul(self.second, d[1])))


def surfaces(c, r):
    """Yields (normal, depth) of what stands still and touches a sphere: lane, gutters, pit, boards, wall."""
    x, y, z = c
    in_gutter = abs(abs(x) - LANE - GUTTER) < GUTTER and y > -GUTTER - 0.02  # which is open at its end
    behind = z < END + 0.06 and y < -0.03 and not in_gutter  # the wall under the lane's end, by a rounding
    if z > END and not behind:
        across = abs(x) - (LANE + GUTTER)
        if abs(across) < GUTTER and y < r:
            length = math.hypot(across, y)
            if y < 0 and length + r > GUTTER:  # in the round of the gutter
                side = 1 if x > 0 else -1
                yield (-side * across / length, -y / length, 0), length + r - GUTTER
            for edge in (-GUTTER, GUTTER):
                away = math.hypot(across - edge, y)
                if y >= 0 and 1e-9 < away < r:
                    yield ((across - edge) / away * (1 if x > 0 else -1), y / away, 0), r - away
        elif y < r:
            yield (0, 1, 0), r - y
    else:
        if y + PIT_DEPTH < r:
            yield (0, 1, 0), r - y - PIT_DEPTH
        if y < 0 and END - z < r and not in_gutter:
            yield (0, 0, -1), r - (END - z)
        elif y >= 0 and abs(x) < LANE:  # the lane's last edge
            away = math.hypot(y, z - END)
            if 1e-9 < away < r:
                yield (0, y / away, (z - END) / away), r - away
        if z - WALL < r:
            yield (0, 0, 1), r - (z - WALL)
    if z < BOARDS and SIDE - abs(x) < r and y < BOARD_HEIGHT:
        yield ((-1 if x > 0 else 1), 0, 0), r - (SIDE - abs(x))


def bodies():
    spheres = [((0, h - PIN_CENTRE, 0), pin_radius(h)) for h in
               [0.045 + k * (PIN_HEIGHT - 1.273 * INCH - 0.045) / 13 for k in range(14)]]
    foot = 2.031 / 2 * INCH
    spheres += [((foot * math.sin(k * math.pi / 4), -PIN_CENTRE, foot * math.cos(k * math.pi / 4)), 0.0) for k in range(8)]
    moment = 0.4 * BALL_MASS * BALL_RADIUS**2
    ball = Body("ball", (START_X, BALL_RADIUS, START_Z), BALL_MASS, moment, moment, [((0, 0, 0), BALL_RADIUS)])
    ball.velocity = (DRIFT * SPEED, 0, -SPEED)
    ball.spin = (-SPEED / BALL_RADIUS, 0, -DRIFT * SPEED / BALL_RADIUS)
    all_bodies, number = [ball], 1
    for row in range(4):
        for k in range(row + 1):
            place = (SPACING * (k - row / 2), PIN_CENTRE, -row * SPACING * math.sqrt(3) / 2)
            all_bodies.append(Body(f"pin {number}", place, PIN_MASS, PIN_ACROSS, PIN_ALONG, spheres))
            number += 1
    return all_bodies


def contacts_of(all_bodies):
    found = []
    for i, a in enumerate(all_bodies):
        for b in all_bodies[i + 1:]:
            d = sub(a.position, b.position)
            if (a.sleeps and b.sleeps) or dot(d, d) > (a.reach + b.reach)**2:
                continue
            deepest = None
            for ca, ra in a.world:
                pa = add(ca, d)
                for cb, rb in b.world:
                    if ra == 0 or rb == 0:
                        continue
                    away = sub(pa, cb)
                    square = dot(away, away)
                    if square < (ra + rb)**2:
                        length = math.sqrt(square)
                        depth = ra + rb - length
                        if deepest is None or depth > deepest[0]:
                            normal = mul(away, 1 / length)
                            deepest = (depth, normal, add(add(b.position, cb), mul(normal, rb - depth / 2)))
            if deepest:
                for body in (a, b):
                    body.sleeps = False
                found.append(Contact(a, b, deepest[2], deepest[1], deepest[0], 0.62, 0.2))
        if a.sleeps:
            continue
        for c, r in a.world:
            centre = add(c, a.position)
            if centre[1] - r > 0.02 and abs(centre[0]) + r < SIDE and centre[2] - r > WALL:
                continue
            for normal, depth in surfaces(centre, r):
                soft = normal[1] < 0.5
                found.append(Contact(a, None, sub(centre, mul(normal, r - depth / 2)), normal, depth,
                                     0.05 if soft and normal[2] > 0.5 else 0.3, 0.08 if a.is_ball else 0.28))
    return found


def simulate():
    all_bodies = bodies()
    frames, every = [], round(FRAME / STEP)
    for step in range(round(SECONDS / STEP) + 1):
        for body in all_bodies:
            body.place()
        if step % every == 0:
            frames.append((step * STEP, [(body.position, body.turn) for body in all_bodies]))
        awake = [body for body in all_bodies if not body.sleeps]
        for body in awake:
            body.velocity = add(body.velocity, (0, -GRAVITY * STEP, 0))
        found = contacts_of(all_bodies)
        for _ in range(ROUNDS):
            for contact in found:
                contact.solve()
        for body in all_bodies:
            if body.sleeps:
                continue
            body.spin = mul(body.spin, 1 - 0.4 * STEP)
            body.position = add(body.position, mul(body.velocity, STEP))
            spin = product((0.0, *body.spin), body.turn)
            body.turn = unit(tuple(q + 0.5 * STEP * s for q, s in zip(body.turn, spin)))
    return all_bodies, frames


def between(a, b, share):
    """Interpolates (position, turn) as a scene does."""
    position = tuple(x + share * (y - x) for x, y in zip(a[0], b[0]))
    cosine = sum(x * y for x, y in zip(a[1], b[1]))
    other = b[1] if cosine >= 0 else tuple(-x for x in b[1])
    angle = math.acos(min(1.0, abs(cosine)))
    if angle < 1e-6:
        return position, a[1]
    return position, tuple((math.sin((1 - share) * angle) * x + math.sin(share * angle) * y) / math.sin(angle)
                           for x, y in zip(a[1], other))


def turn_between(p, q):
    return 2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(p, q)))))


def thinned(track):
    """Leaves out frames that the others give within the bounds: [(time, (position, turn))]."""
    kept, first = [track[0]], 0
    while first < len(track) - 1:
        last = first + 1
        while last + 1 < len(track):
            a, b = track[first], track[last + 1]
            good, total = True, 0.0
            for k in range(first, last + 1):
                total += turn_between(track[k][1][1], track[k + 1][1][1])
            good = total < 2.6  # a turn between keyframes is below 180 degrees
            for k in range(first + 1, last + 1):
                if not good:
                    break
                position, turn = between(a[1], b[1], (track[k][0] - a[0]) / (b[0] - a[0]))
                off = sub(position, track[k][1][0])
                good = dot(off, off) < 0.001**2 and turn_between(unit(turn), track[k][1][1]) < math.radians(1)
            if not good:
                break
            last += 1
        kept.append(track[last])
        first = last
    return kept


def keyframe(time, pose, height):
    """`height` is that of the centre of mass over the asset's origin."""
    position, turn = pose
    place = sub(position, turned(turn, (0, height, 0)))
    sine = math.sqrt(sum(x * x for x in turn[1:]))
    angle = math.degrees(2 * math.atan2(sine, turn[0]))
    text = "{time: %.4g, translate: [%s]" % (time, ", ".join("%.4f" % (x + 0.0) for x in place))
    axis = mul(turn[1:], 1 / sine) if sine > 1e-9 else (0, 1, 0)
    return text + ", rotate: {axis: [%s], degrees: %.2f}}" % (", ".join("%.4f" % x for x in axis), angle if sine > 1e-9 else 0)


HEAD = """# A ball rolls into ten pins. Every body shadows the others and the alley as it moves; each is an asset of its own, with its
# own shadows on itself. Build the assets (strike-assets.yaml), then, with light at every vertex of them:
#
#     build/release/bin/kiln-render samples/strike.yaml --incident-samples vertices --time 0.35 --frames 6 --fps 6 --strip \\
#         --width 260 --height 200 -o strike.png
#     build/release/bin/kiln-view samples/strike.yaml --by transfer --incident-samples vertices
#
# or by shaders, whose pictures samples/bowling/make.py makes:
#
#     python3 samples/bowling/make.py out/bowling
#     build/release/bin/kiln-shade samples/strike.yaml --time 0.6 -o strike.png
#
# The motion is made by samples/strike/simulate.py.
shaders: shaders
lights:
  - {directional: [112, 50], radiance: 1.3, radius: 10}
  - {hemisphere: [0, 90], radiance: 0.3, ground: 0.1}
camera: {azimuth: 14, elevation: 21, target: [0, 0.05, -0.42], distance: 3.6, field-of-view: 30}
background: 0.02
duration: %g
nodes:
  - {name: alley, asset: ../out/strike/alley/prt, static: true, shader: alley, mirror: true}
"""


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    all_bodies, frames = simulate()
    text = HEAD % SECONDS
    for k, body in enumerate(all_bodies):
        asset, height = ("ball", 0) if body.is_ball else ("pin", PIN_CENTRE)
        more = "    set: {band_axis: [0, 1, 0]}\n" if body.is_ball else ""  # the band shows how it rolls about X
        text += f"  - name: {body.name}\n    asset: ../out/strike/{asset}/prt\n    shader: {asset}\n{more}    animate:\n      keyframes:\n"
        for time, pose in thinned([(t, poses[k]) for t, poses in frames]):
            text += f"        - {keyframe(time, pose, height)}\n"
    pathlib.Path(sys.argv[1]).write_text(text)
    fallen = sum(body.axis[1] < 0.8 or body.position[1] < 0.05 for body in all_bodies[1:])
    print(f"{fallen} of 10 pins have fallen; {text.count('time:')} keyframes")


if __name__ == "__main__":
    main()
