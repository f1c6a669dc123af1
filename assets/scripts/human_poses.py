"""Thirty poses of the body, written by hand, and how they turn anny's bones.

A pose says in which directions limbs point, x outward, y backward (so a negative y is forward), z up; arms in the frame
of the chest, legs in that of the pelvis. `jitter` varies a pose a little from person to person.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

Direction = tuple[float, float, float]


@dataclass(frozen=True)
class Pose:
    """Limbs as (upper, lower) directions; angles in degrees as (pitch forward, roll to the left, yaw to the left).

    left_arm, right_arm : upper arm and forearm. left_leg, right_leg : thigh and shin. root : the pelvis.
    curl : of the fingers, of one hand if left_curl or right_curl is given. toe_out : of both feet.
    flat_feet : soles follow the ground rather than hang.
    """

    left_arm: tuple[Direction, Direction] = ((0.40, -0.05, -0.92), (0.36, -0.25, -0.90))
    right_arm: tuple[Direction, Direction] = ((0.40, -0.05, -0.92), (0.36, -0.25, -0.90))
    left_leg: tuple[Direction, Direction] = ((0.10, -0.03, -1), (0.07, 0.04, -1))
    right_leg: tuple[Direction, Direction] = ((0.10, -0.03, -1), (0.07, 0.04, -1))
    spine: Direction = (0, 0, 0)
    neck: Direction = (0, 0, 0)
    root: Direction = (0, 0, 0)
    curl: float = 15
    left_curl: float | None = None
    right_curl: float | None = None
    toe_out: float = 5
    flat_feet: bool = True

    def mirrored(self):
        """Left and right exchanged."""
        turned = {name: tuple(np.array(getattr(self, name)) * [1, -1, -1]) for name in ("spine", "neck", "root")}
        return replace(
            self,
            left_arm=self.right_arm,
            right_arm=self.left_arm,
            left_leg=self.right_leg,
            right_leg=self.left_leg,
            left_curl=self.right_curl,
            right_curl=self.left_curl,
            **turned,
        )

    def blended(self, other, share):
        """`share` of the way towards `other`; fingers and feet stay."""
        mixed = {}
        for name in ("left_arm", "right_arm", "left_leg", "right_leg"):
            pairs = zip(getattr(self, name), getattr(other, name), strict=True)
            mixed[name] = tuple(tuple(unit((1 - share) * unit(a) + share * unit(b))) for a, b in pairs)
        for name in ("spine", "neck", "root"):
            mixed[name] = tuple((1 - share) * np.array(getattr(self, name)) + share * np.array(getattr(other, name)))
        return replace(self, **mixed)


def both_arms(upper, lower):
    return {"left_arm": (upper, lower), "right_arm": (upper, lower)}


def both_legs(upper, lower):
    return {"left_leg": (upper, lower), "right_leg": (upper, lower)}


POSES = {
    "neutral": Pose(),
    "t_pose": Pose(curl=5, **both_arms((1, 0, 0.02), (1, -0.12, 0.02)), **both_legs((0.25, 0, -1), (0.22, 0.05, -1))),
    "arms_up": Pose(neck=(-10, 0, 0), **both_arms((0.55, 0, 0.83), (0.35, -0.12, 0.93))),
    "walk": Pose(
        left_arm=((0.22, 0.55, -0.8), (0.18, 0.25, -0.95)),
        right_arm=((0.2, -0.45, -0.87), (0.05, -0.85, -0.5)),
        left_leg=((0.04, -0.48, -0.88), (0.02, -0.22, -0.97)),
        right_leg=((0.04, 0.28, -0.96), (0.02, 0.65, -0.76)),
        spine=(4, 0, -8),
        flat_feet=False,
    ),
    "run": Pose(
        left_arm=((0.3, 0.8, -0.55), (0.22, -0.15, -0.97)),
        right_arm=((0.25, -0.55, -0.8), (-0.15, -0.75, 0.65)),
        left_leg=((0.05, -0.8, -0.6), (0.02, 0.35, -0.94)),
        right_leg=((0.04, 0.45, -0.89), (0.02, 0.95, -0.3)),
        spine=(14, 0, -14),
        root=(8, 0, 0),
        curl=40,
        flat_feet=False,
    ),
    "sit": Pose(
        spine=(6, 0, 0),
        **both_arms((0.28, -0.35, -0.9), (0.1, -0.95, -0.25)),
        **both_legs((0.2, -0.97, -0.1), (0.06, 0.02, -1)),
    ),
    "squat_reach": Pose(
        spine=(18, 0, 0),
        root=(18, 0, 0),
        curl=10,
        **both_arms((0.25, -0.95, 0.1), (0.12, -1, 0.12)),
        **both_legs((0.38, -0.9, -0.3), (0.06, 0.55, -0.84)),
    ),
    "kick": Pose(
        left_arm=((0.65, 0.4, -0.55), (0.6, 0.05, -0.75)),
        right_arm=((0.55, -0.7, 0.1), (0.2, -0.95, 0.2)),
        left_leg=((0.08, -0.86, -0.35), (0.06, -0.92, -0.1)),
        right_leg=((0.06, 0.02, -1), (0.05, 0.12, -1)),
        spine=(10, 0, 12),
        root=(-10, 0, 0),
        curl=35,
        flat_feet=False,
    ),
    "bend_forward": Pose(
        spine=(42, 0, 0),
        neck=(10, 0, 0),
        root=(38, 0, 0),
        **both_arms((0.22, -0.8, -0.55), (0.12, -0.95, -0.35)),
        **both_legs((0.1, -0.55, -0.82), (0.06, -0.4, -0.92)),
    ),
    "twist_guard": Pose(
        left_arm=((0.35, -0.45, -0.8), (-0.25, -0.8, 0.55)),
        right_arm=((0.45, -0.6, -0.55), (-0.1, -0.75, 0.7)),
        left_leg=((0.18, -0.3, -0.93), (0.1, 0.12, -0.98)),
        right_leg=((0.22, 0.22, -0.95), (0.12, 0.3, -0.94)),
        spine=(6, 4, 32),
        neck=(0, 0, -18),
        curl=45,
    ),
    "star": Pose(
        curl=0,
        flat_feet=False,
        **both_arms((0.8, 0, 0.6), (0.75, -0.12, 0.65)),
        **both_legs((0.5, 0, -0.86), (0.47, 0.04, -0.88)),
    ),
    "hands_on_hips": Pose(curl=30, **both_arms((0.72, 0.3, -0.62), (-0.55, -0.45, -0.6))),
    "hands_on_head": Pose(curl=25, **both_arms((0.88, -0.1, 0.42), (-0.55, 0.05, 0.8))),
    "wave_right": Pose(right_arm=((0.8, -0.1, 0.25), (0.25, -0.3, 0.9)), spine=(0, -4, 0), curl=8),
    "point_left": Pose(left_arm=((0.55, -0.8, 0.1), (0.55, -0.83, 0.1)), spine=(0, 0, 10), left_curl=0),
    "lunge_left": Pose(
        left_arm=((0.6, -0.1, -0.75), (0.45, -0.55, -0.65)),
        right_arm=((0.6, 0.1, -0.75), (0.45, -0.45, -0.7)),
        left_leg=((0.08, -0.88, -0.42), (0.03, 0.05, -1)),
        right_leg=((0.06, 0.52, -0.85), (0.03, 0.7, -0.71)),
        spine=(6, 0, 0),
        flat_feet=False,
    ),
    "lunge_side": Pose(
        left_leg=((0.72, -0.35, -0.58), (0.1, 0.1, -0.98)),
        right_leg=((0.62, 0, -0.78), (0.6, 0.04, -0.8)),
        flat_feet=False,
        **both_arms((0.95, -0.2, 0.1), (0.9, -0.4, 0.1)),
    ),
    "tree": Pose(
        right_leg=((0.75, -0.45, -0.42), (-0.52, 0.25, -0.8)),
        curl=5,
        flat_feet=False,
        **both_arms((0.5, -0.05, 0.86), (-0.15, -0.1, 0.98)),
    ),
    "arabesque": Pose(
        left_leg=((0.05, -0.62, -0.78), (0.04, -0.58, -0.82)),
        right_leg=((0.08, 0.62, -0.78), (0.06, 0.72, -0.68)),
        spine=(-18, 0, 0),
        neck=(-20, 0, 0),
        root=(40, 0, 0),
        flat_feet=False,
        **both_arms((0.85, -0.5, 0.2), (0.8, -0.6, 0.2)),
    ),
    "throw": Pose(
        left_arm=((0.6, -0.75, 0.15), (0.45, -0.85, 0.2)),
        right_arm=((0.75, 0.35, 0.5), (0.1, 0.45, 0.85)),
        left_leg=((0.15, -0.45, -0.88), (0.08, -0.1, -0.99)),
        right_leg=((0.2, 0.22, -0.95), (0.12, 0.38, -0.92)),
        spine=(-6, -6, -28),
        right_curl=40,
    ),
    "boxing": Pose(
        left_arm=((0.3, -0.62, -0.7), (-0.12, -0.78, 0.62)),
        right_arm=((0.32, -0.4, -0.85), (-0.2, -0.72, 0.66)),
        left_leg=((0.12, -0.35, -0.92), (0.06, 0.15, -0.98)),
        right_leg=((0.16, 0.15, -0.97), (0.1, 0.35, -0.93)),
        spine=(12, 0, -16),
        curl=45,
    ),
    "side_bend": Pose(
        left_arm=((0.3, 0, -0.95), (0.25, -0.2, -0.95)),
        right_arm=((0.45, 0, 0.9), (0.15, -0.1, 0.98)),
        spine=(0, 30, 0),
        neck=(0, 12, 0),
    ),
    "back_arch": Pose(spine=(-28, 0, 0), neck=(-18, 0, 0), **both_arms((0.7, 0.4, 0.5), (0.65, 0.25, 0.65))),
    "kneel_right": Pose(
        left_arm=((0.25, -0.45, -0.85), (0.05, -0.9, -0.3)),
        left_leg=((0.12, -0.97, -0.12), (0.04, 0.05, -1)),
        right_leg=((0.08, 0.08, -0.99), (0.03, 0.97, -0.15)),
        flat_feet=False,
    ),
    "reach_down": Pose(
        left_arm=((0.2, -0.55, -0.8), (0.1, -0.65, -0.75)),
        right_arm=((0.5, 0.3, -0.75), (0.42, 0.05, -0.85)),
        left_leg=((0.15, -0.62, -0.76), (0.07, 0.15, -0.98)),
        right_leg=((0.15, -0.55, -0.82), (0.07, 0.1, -0.99)),
        spine=(30, 0, 16),
        root=(20, 0, 0),
    ),
    "hug": Pose(
        left_arm=((0.55, -0.83, 0.05), (-0.42, -0.88, 0.05)),
        right_arm=((0.55, -0.83, 0.1), (-0.4, -0.88, 0.2)),
        curl=20,
    ),
    "march": Pose(
        left_arm=((0.28, 0.45, -0.83), (0.22, 0.15, -0.95)),
        right_arm=((0.25, -0.6, -0.75), (0.1, -0.8, 0.5)),
        left_leg=((0.06, -0.98, -0.05), (0.03, 0.15, -0.98)),
        curl=40,
        flat_feet=False,
    ),
    "jump": Pose(
        left_arm=((0.75, -0.2, 0.62), (0.6, -0.4, 0.7)),
        right_arm=((0.8, -0.1, 0.5), (0.6, -0.35, 0.7)),
        left_leg=((0.28, -0.6, -0.74), (0.12, 0.55, -0.82)),
        right_leg=((0.22, -0.3, -0.92), (0.1, 0.85, -0.5)),
        spine=(-6, 0, 0),
        curl=10,
        flat_feet=False,
    ),
    "look_left": Pose(left_arm=((0.55, -0.15, -0.8), (0.4, -0.62, -0.65)), spine=(0, 0, 10), neck=(0, 0, 45)),
    "phone": Pose(right_arm=((0.45, -0.4, -0.78), (-0.22, -0.12, 0.97)), neck=(5, -8, 0), right_curl=40),
}


def unit(vector):
    vector = np.asarray(vector, dtype=float)
    return vector / np.linalg.norm(vector)


def bone_turns(pose, heads, labels, jitter):
    """(bones, 4, 4): how each bone turns in its own rest frame.

    heads : bone → where its rest position starts. labels : the bones in anny's order. jitter : a numpy Generator.
    """
    turns = np.tile(np.eye(4), (len(labels), 1, 1))

    def put(bone, rotation):
        turns[labels.index(bone), :3, :3] = rotation.as_matrix()

    put("root", _euler(np.array(pose.root) + jitter.normal(0, 2, 3)))
    spine = np.array(pose.spine) + jitter.normal(0, 2.0, 3)
    for number, share in zip((5, 4, 3, 2, 1), (0.16, 0.24, 0.24, 0.22, 0.14), strict=True):
        put(f"spine0{number}", _euler(spine * share))
    neck = np.array(pose.neck) + jitter.normal(0, 3.0, 3)
    for bone, share in zip(("neck01", "neck02", "neck03", "head"), (0.25, 0.25, 0.2, 0.3), strict=True):
        put(bone, _euler(neck * share))
    for side, name, sign in (("L", "left", 1.0), ("R", "right", -1.0)):

        def head(bone, side=side):
            return heads[f"{bone}.{side}"]

        def turn(bone, rotation, side=side):
            put(f"{bone}.{side}", rotation)

        flip = np.array([sign, 1, 1])
        _turn_arm(turn, head, [unit(unit(v) * flip + jitter.normal(0, 0.05, 3)) for v in getattr(pose, f"{name}_arm")])
        turn("wrist", Rotation.from_rotvec(jitter.normal(0, 0.05, 3)))
        curl = getattr(pose, f"{name}_curl")
        _curl_fingers(turn, head, pose.curl if curl is None else curl)
        limbs = [unit(unit(v) * flip + jitter.normal(0, 0.03, 3)) for v in getattr(pose, f"{name}_leg")]
        _turn_leg(turn, head, limbs, pose, sign * pose.toe_out)
    return turns


def _turn_arm(turn, head, directions):
    upper, lower = directions
    rest_upper, rest_lower = unit(head("lowerarm01") - head("upperarm01")), unit(head("wrist") - head("lowerarm01"))
    rest_axis, axis = unit(np.cross(rest_upper, rest_lower)), np.cross(upper, lower)
    # A straight arm has no elbow axis of its own; forward decides then.
    hint = np.cross(upper, [0, -1, 0] if abs(upper[1]) < 0.9 else [0, 0, 1])
    share = np.clip(np.linalg.norm(axis) / 0.35, 0, 1)
    axis = unit(share * unit(axis) + (1 - share) * unit(hint)) if share < 1 else unit(axis)
    whole = Rotation.from_matrix(_frame(upper, axis) @ _frame(rest_upper, rest_axis).T)
    swing = _swing(rest_upper, upper)
    twist = (swing.inv() * whole).as_rotvec()
    # The shoulder girdle takes part of the swing, and the upper arm's twist is spread over its two bones.
    clavicle, shoulder = (Rotation.from_rotvec(swing.as_rotvec() * part) for part in (0.16, 0.12))
    turn("clavicle", clavicle)
    turn("shoulder01", shoulder)
    turn("upperarm01", (clavicle * shoulder).inv() * swing * Rotation.from_rotvec(twist * 0.5))
    turn("upperarm02", Rotation.from_rotvec(twist * 0.5))
    bend = np.arccos(np.clip(upper @ lower, -1, 1)) - np.arccos(rest_upper @ rest_lower)
    turn("lowerarm01", Rotation.from_rotvec(rest_axis * bend))


def _curl_fingers(turn, head, degrees):
    knuckles = unit(head("finger2-1") - head("finger5-1"))
    along = unit(head("finger3-2") - head("finger3-1"))
    axis = unit(knuckles - (along @ knuckles) * along)
    sense = np.sign(np.cross(along, head("finger3-3") - head("finger3-2")) @ axis) or 1.0
    for finger in (2, 3, 4, 5):
        for joint, share in ((1, 0.9), (2, 1.0), (3, 0.7)):
            angle = np.radians(degrees * share * (1 + 0.06 * (finger - 3)))
            turn(f"finger{finger}-{joint}", Rotation.from_rotvec(sense * axis * angle))


def _turn_leg(turn, head, directions, pose, toe_out):
    upper, lower = directions
    rest_upper, rest_lower = unit(head("lowerleg01") - head("upperleg01")), unit(head("foot") - head("lowerleg01"))
    x = np.array([1.0, 0, 0])
    axis = np.cross(upper, lower)
    share = np.clip(np.linalg.norm(axis) / 0.5, 0, 1)
    axis = unit(share * (unit(axis) if np.linalg.norm(axis) > 1e-6 else x) + (1 - share) * x)
    axis = -axis if axis[0] < 0 else axis
    out = Rotation.from_euler("z", toe_out, degrees=True)
    whole = Rotation.from_matrix(_frame(upper, out.apply(axis)) @ _frame(rest_upper, x).T)
    swing = _swing(rest_upper, upper)
    twist = (swing.inv() * whole).as_rotvec()
    pelvis = Rotation.from_rotvec(swing.as_rotvec() * 0.12)
    turn("pelvis", pelvis)
    turn("upperleg01", pelvis.inv() * swing * Rotation.from_rotvec(twist * 0.5))
    turn("upperleg02", Rotation.from_rotvec(twist * 0.5))
    knee = whole.inv() * _swing(whole.apply(rest_lower), lower) * whole
    turn("lowerleg01", knee)
    ankle = np.array([np.radians(18.0), 0, 0])
    if pose.flat_feet:
        ankle = ((whole * knee).inv() * out * _euler(pose.root).inv()).as_rotvec()
    size = np.linalg.norm(ankle)
    turn("foot", Rotation.from_rotvec(ankle * min(1, np.radians(38) / max(size, 1e-9))))


def _euler(angles):
    """Pitch about x bends forward: the head goes from +z towards -y."""
    return Rotation.from_euler("zyx", [angles[2], angles[1], angles[0]], degrees=True)


def _swing(start, end):
    """The shortest turn from one direction to another."""
    start, end = unit(start), unit(end)
    axis = np.cross(start, end)
    sine, cosine = np.linalg.norm(axis), start @ end
    if sine < 1e-9:
        return Rotation.identity() if cosine > 0 else Rotation.from_rotvec(np.pi * unit(np.cross(start, [0.3, 1, 0.2])))
    return Rotation.from_rotvec(axis / sine * np.arctan2(sine, cosine))


def _frame(direction, axis):
    """Columns: `direction`, the part of `axis` across it, and their cross product."""
    direction = unit(direction)
    axis = unit(axis - (direction @ axis) * direction)
    return np.stack([direction, axis, np.cross(direction, axis)], axis=1)
