"""The same command under three laws: how far does the hand's velocity leave what was commanded?"""

import overreach as ov

for law in ("exact", "paper", "switch"):
    summary = ov.simulate("aside", law).summary
    print(
        f"{law:<7} EE velocity error at most {summary.ee_error_max:.3f} m/s, psi at the end {summary.psi_end:.3f} rad"
    )
