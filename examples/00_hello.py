"""One velocity, shared: inside the workspace the arm moves, beyond it the base, between them both."""

import overreach as ov

robot = ov.planar(workspace=ov.Workspace(l_min=0.45, l_max=0.85, psi_min=-0.6, psi_max=0.6))
share = ov.Exact(blend=ov.Smoothstep(q_l=0.1, q_psi=0.1)).bind(robot)

for length in (0.65, 0.85, 0.95):
    split = share(length, 0.0, 0.4, 0.0)  # l [m], psi [rad], outward and sideways [m/s]
    print(f"l = {length} m: base {split.v_b:.2f} m/s, arm {split.v_m:.2f} m/s")
