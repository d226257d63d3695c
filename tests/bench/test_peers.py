"""The bench of a robot in space: every number is there, and mink does the same task."""

from __future__ import annotations

import numpy as np

from overreach.bench import spatial
from overreach.bench.peers import peers
from overreach.model.catalogue import description_of, parts_in


def test_the_peers_move_the_hand_as_it_is_asked() -> None:
    """At home, mink on the chain and on the whole model moves the hand as commanded, to its own damping."""
    found = parts_in(*description_of("mobile7"), "follow")
    q, u = np.array(found.arm.home), np.array((0.1, 0.05, 0.03))
    joints = len(q)
    chain = found.arm.at(tuple(q.tolist()), found.mount)
    for peer in peers(found):
        rates = peer.solve(q, u)
        if "chain" not in peer.name:
            continue
        base, dq = rates[:3], rates[3 : 3 + joints]
        moved = chain.J[:3] @ dq + (base[0] - base[2] * chain.pose[10], base[1] + base[2] * chain.pose[9], 0.0)
        assert np.abs(moved - u).max() < 0.3 * float(np.linalg.norm(u)), (peer.name, moved)


def test_the_bench_says_everything() -> None:
    """A short run: times of all, ratios to the faster peer, and each target with what was reached."""
    found = spatial.measure("mobile4", rounds=1)
    names = {spatial.COMPILED, spatial.LEAN, spatial.TICK, "mink + daqp, whole model", "mink + daqp, chain only"}
    assert set(found["step_us"]) == names
    assert all(one["median"] > 0.0 for one in found["step_us"].values())
    assert found["faster_peer"].startswith("mink")
    assert len(found["targets"]) == 5
    text = spatial.text(found)
    assert all(name in text for name in names)
