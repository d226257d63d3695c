"""Drive a simulated robot from a script: 10 s of "forward" at 200 Hz, with the arm 0.4 rad to the left."""

from math import degrees

import overreach as ov

robot = ov.KinematicRobot(psi=0.4)
hand = ov.HandController(robot.model, ov.Exact())
dt = 1 / 200
for k in range(2000):
    now = k * dt
    step = hand.step(robot.read(now), v_c=0.4, w_c=0.0, dt=dt)
    robot.write(step.twist, step.dtheta, now)
state = robot.read(2000 * dt)
print(f"base at ({state.x_b:.2f}, {state.y_b:.2f}) m, heading {degrees(state.theta_b):.1f} deg")
