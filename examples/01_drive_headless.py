"""Drive a simulated robot from a script: 10 s of "forward" at 200 Hz, with the arm 0.4 rad to the left."""

from math import degrees

import overreach as ov

robot = ov.KinematicRobot(psi=0.4)
pilot = ov.Pilot(robot.model, ov.Exact())
pilot.ask(ov.ArmRequest(operator=1), now=0.0)
dt = 1 / 200
for k in range(2000):
    now = k * dt
    command = ov.Command(1, seq=k + 1, grip=1, held=True, twist=ov.Twist(v_x=0.4), frame=ov.Frame.HAND, seen=now)
    tick = pilot.tick(robot.read(now), command, now, dt)
    robot.write(tick.base, tick.joints, tick.gripper, now, now + 2 * dt)
state = robot.read(2000 * dt)
print(f"base at ({state.x_b:.2f}, {state.y_b:.2f}) m, heading {degrees(state.theta_b):.1f} deg")
