"""One velocity, shared: inside the workspace the arm moves, beyond it the base, between them both."""

import overreach as ov

law = ov.exact(ov.Workspace(l_min=0.45, l_max=0.85, psi_min=-0.6, psi_max=0.6), ov.smoothstep(q_l=0.1, q_psi=0.1))

for length in (0.65, 0.85, 0.95):
    split = law.split(l=length, psi=0.0, u_r=0.4, u_t=0.0)
    print(f"l = {length} m: base {split.v_b:.2f} m/s, arm {split.v_m:.2f} m/s")
