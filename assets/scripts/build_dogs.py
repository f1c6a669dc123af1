"""Make dogs_40x6890.npz from dm_control's dog: `python build_dogs.py [OUTPUT_FOLDER]`."""

import struct
import sys
from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import quantised
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation
from symmetric_decimation import decimate, mirrored


class Skin:
    """A MuJoCo skin: vertices that follow the bodies of a model by linear blending."""

    def __init__(self, path):
        self._data, self._at = path.read_bytes(), 16
        vertex_count, texture_count, face_count, bone_count = struct.unpack("<4i", self._data[:16])
        self.vertices = self._take("<f4", 3 * vertex_count).reshape(-1, 3).astype(float)
        self._take("<f4", 2 * texture_count)
        self.faces = self._take("<i4", 3 * face_count).reshape(-1, 3).astype(int)
        self.bones, self.weights = [], np.zeros((vertex_count, bone_count))
        for bone in range(bone_count):
            name = self._take("S40", 1)[0].decode()
            position, quaternion = self._take("<f4", 3).astype(float), self._take("<f4", 4).astype(float)
            count = int(self._take("<i4", 1)[0])
            moved = self._take("<i4", count)
            self.weights[moved, bone] += self._take("<f4", count)
            self.bones.append((name, position, Rotation.from_quat(quaternion, scalar_first=True).as_matrix()))
        self.weights /= self.weights.sum(axis=1, keepdims=True)
        self._weld()

    def posed(self, model, data, joints):
        """(n, 3): the skin when the model's joints have the values `joints`."""
        data.qpos[:] = joints
        mujoco.mj_kinematics(model, data)
        result = np.zeros_like(self.vertices)
        for bone, (name, position, rest) in enumerate(self.bones):
            body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
            turn = data.xmat[body].reshape(3, 3) @ rest.T
            result += self.weights[:, bone, None] * ((self.vertices - position) @ turn.T + data.xpos[body])
        return result

    def make_symmetric(self):
        """Mirror map about y = 0; positions averaged with their mirror images, faces of one half mirrored."""
        mirror = cKDTree(self.vertices).query(self.vertices * [1, -1, 1])[1]
        if (mirror[mirror] != np.arange(len(mirror))).any():
            raise RuntimeError("the skin is not symmetric")
        self.vertices = 0.5 * (self.vertices + self.vertices[mirror] * [1, -1, 1])
        side = np.where(mirror == np.arange(len(mirror)), 0.0, np.sign(self.vertices[:, 1]))
        self.faces = mirrored(self.faces[side[self.faces].sum(axis=1) > 0], mirror)
        return mirror

    def _take(self, kind, count):
        values = np.frombuffer(self._data, kind, count, self._at)
        self._at += values.nbytes
        return values

    def _weld(self):
        """Join vertices that texture seams had split."""
        _, first, number = np.unique(np.round(self.vertices / 1e-6), axis=0, return_index=True, return_inverse=True)
        faces = number.ravel()[self.faces]
        distinct = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        self.vertices, self.weights, self.faces = self.vertices[first], self.weights[first], faces[distinct]


def random_joints(model, rng):
    """Joint values within their limits; the joints of spine and tail move together."""
    joints, shared = model.qpos0.copy(), {}
    for joint in range(model.njnt):
        if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
            continue
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)
        in_spine = name[:2] in ("L_", "C_", "Ca")
        group = name.split("_")[0] + name.split("_")[-1] if in_spine else name
        share = shared.setdefault(group, rng.beta(2, 2))
        low, high = model.jnt_range[joint]
        amplitude = 0.45 if in_spine else 0.75
        address = model.jnt_qposadr[joint]
        joints[address] = amplitude * (low + (high - low) * share) + (1 - amplitude) * model.qpos0[address]
    return joints


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else quantised.SHAPES
    suite = Path(find_spec("dm_control").submodule_search_locations[0]) / "suite"
    skin = Skin(suite / "dog_assets" / "dog_skin.skn")
    mirror = skin.make_symmetric()
    chosen, faces, chosen_mirror = decimate(skin.vertices, skin.faces, mirror, 6890, axis=1)
    print(f"skins of {len(mirror):,} and {len(chosen):,} vertices")
    model = mujoco.MjModel.from_xml_path(str(suite / "dog.xml"))
    data, rng = mujoco.MjData(model), np.random.default_rng(3)
    joints = [model.qpos0.copy()] + [random_joints(model, rng) for _ in range(39)]
    bodies = [skin.posed(model, data, values)[chosen] for values in joints]
    poses = ["standing"] + [f"pose {number}" for number in range(1, 40)]
    quantised.save(folder / "dogs_40x6890.npz", bodies, faces, chosen_mirror, subjects=[0] * 40, poses=poses)


if __name__ == "__main__":
    main()
