"""The twin of `screws.forward`: MuJoCo's kinematics of a chain that has these screws and nothing else."""

from __future__ import annotations

import threading
from typing import final

import mujoco
import numpy as np

from overreach.arm.spatial.screws import Array


def model_of(screws: Array, tip: Array) -> mujoco.MjModel:
    """Return a chain of bodies with these screws and nothing else, its hand the site `hand`."""
    spec = mujoco.MjSpec()
    body = spec.worldbody
    for k, (a_x, a_y, a_z, x, y, z, slide) in enumerate(screws.tolist()):
        body = body.add_body(name=f"body_{k}")
        body.mass, body.inertia, body.explicitinertial = 1.0, [1.0, 1.0, 1.0], True
        kind = mujoco.mjtJoint.mjJNT_SLIDE if slide else mujoco.mjtJoint.mjJNT_HINGE
        body.add_joint(name=f"joint_{k}", type=kind, axis=[a_x, a_y, a_z], pos=[x, y, z])
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, tip[:9])
    body.add_site(name="hand", pos=tip[9:12].tolist(), quat=quat.tolist())
    return spec.compile()


@final
class Kinematics:
    """Forward kinematics of one arm, from any thread."""

    def __init__(self, screws: Array, tip: Array) -> None:
        self._model = model_of(screws, tip)
        self._local = threading.local()

    def _data(self) -> mujoco.MjData:
        local = self._local
        try:
            return local.data
        except AttributeError:
            data = local.data = mujoco.MjData(self._model)
            return data

    def forward(self, q: Array, hand: Array, J: Array, places: Array) -> None:
        """See `screws.forward`."""
        data = self._data()
        data.qpos[:] = q
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_comPos(self._model, data)
        mujoco.mj_jacSite(self._model, data, J[:3], J[3:], 0)
        hand[:9] = data.site_xmat[0]
        hand[9:] = data.site_xpos[0]
        places[:] = data.xanchor

    def pose(self, q: Array, hand: Array) -> None:
        """Write the hand's pose alone."""
        data = self._data()
        data.qpos[:] = q
        mujoco.mj_kinematics(self._model, data)
        hand[:9] = data.site_xmat[0]
        hand[9:] = data.site_xpos[0]
