"""Make humans_100x6890.npz and poses_71x12166.npz: `python build_humans.py [OUTPUT_FOLDER]`.

anny's first use prepares its data in $ANNY_CACHE_DIR, which takes minutes, 4 GB of memory and 0.8 GB of disk.
"""

import sys
from pathlib import Path

import anny
import numpy as np
import quantised
import torch
from human_poses import POSES, bone_turns
from human_template import BASE, build_skins
from scipy.spatial.transform import Rotation

# gender: 0 male, 1 female; age: 2/3 young adult, 1 old; heights of 0.28 to 0.50 give realistic people.
AVERAGE = {
    **{"gender": 0.5, "age": 0.67, "muscle": 0.5, "weight": 0.5, "height": 0.5, "proportions": 0.5, "cupsize": 0.5},
    **{"firmness": 0.5, "african": 0.0, "asian": 0.0, "caucasian": 1.0},
}
PEOPLE = [
    {"gender": 0, "muscle": 0.55, "weight": 0.50, "height": 0.36},
    {"gender": 1, "muscle": 0.45, "weight": 0.48, "height": 0.33, "asian": 1.0, "caucasian": 0.0},
    {"gender": 0, "muscle": 0.90, "weight": 0.60, "height": 0.42, "african": 1.0, "caucasian": 0.0},
    {"gender": 1, "muscle": 0.35, "weight": 0.85, "height": 0.38, "cupsize": 0.7},
    {"gender": 0, "age": 0.80, "muscle": 0.40, "weight": 0.92, "height": 0.33},
    {"gender": 1, "age": 0.66, "muscle": 0.55, "weight": 0.25, "height": 0.50, "proportions": 0.8}
    | {"african": 0.6, "caucasian": 0.4},
    {"gender": 0, "age": 0.95, "muscle": 0.30, "weight": 0.30, "height": 0.32},
    {"gender": 1, "age": 0.92, "muscle": 0.35, "weight": 0.65, "height": 0.28, "cupsize": 0.6, "firmness": 0.3},
    {"gender": 0, "age": 0.52, "muscle": 0.40, "weight": 0.40, "height": 0.40, "asian": 1.0, "caucasian": 0.0},
    {"gender": 1, "age": 0.70, "muscle": 0.85, "weight": 0.55, "height": 0.42}
    | {"african": 0.5, "asian": 0.5, "caucasian": 0.0},
]
SYMMETRIC = {"neutral", "t_pose", "arms_up", "sit", "squat_reach", "bend_forward", "star", "hands_on_hips"}
SYMMETRIC |= {"hands_on_head", "back_arch"}


class Sculptor:
    """Bodies of PEOPLE in poses, as vertices of anny's base mesh."""

    def __init__(self):
        self.model = anny.Anny(topology=BASE, phenotypes="all", skinning_method="dqs").to(dtype=torch.float64)
        self.people = [AVERAGE | person for person in PEOPLE]
        labels = self.model.bone_labels
        rests = [self.model(phenotype_kwargs=person)["rest_bone_poses"][0, :, :3, 3].numpy() for person in self.people]
        self.heads = [dict(zip(labels, rest, strict=True)) for rest in rests]

    def body(self, person, pose, seed):
        """(base vertices, 3) in metres, z up, feet on the ground, looking about along -y."""
        rng = np.random.default_rng(seed)
        turns = bone_turns(pose, self.heads[person], self.model.bone_labels, rng)
        made = self.model(pose_parameters=torch.tensor(turns)[None], phenotype_kwargs=self.people[person])
        vertices = Rotation.from_euler("z", rng.normal(0, 6), degrees=True).apply(made["vertices"][0].numpy())
        return vertices - [*vertices.mean(axis=0)[:2], vertices[:, 2].min()]


def build_people(sculptor, skin, path):
    """Ten people in the first ten poses."""
    names = list(POSES)[:10]
    labels = [(person, number) for person in range(10) for number in range(10)]
    bodies = [skin.W @ sculptor.body(p, POSES[names[k]], 1000 + 10 * p + k) for p, k in labels]
    subjects, poses = [person for person, _ in labels], [names[number] for _, number in labels]
    quantised.save(path, bodies, skin.faces, skin.mirror, subjects=subjects, poses=poses)


def build_poses(sculptor, skin, path):
    """The first person in all poses, in the mirror images of those that differ from theirs, and in random blends."""
    poses = dict(POSES)
    poses |= {f"{name}_mirror": pose.mirrored() for name, pose in POSES.items() if name not in SYMMETRIC}
    rng = np.random.default_rng(7)
    while len(poses) < 71:
        start, end = rng.choice(list(POSES), 2, replace=False)
        share = rng.uniform(0.35, 0.65)
        poses[f"{start}+{end}:{share:.2f}"] = POSES[start].blended(POSES[end], share)
    bodies = [skin.W @ sculptor.body(0, pose, 5000 + number) for number, pose in enumerate(poses.values())]
    quantised.save(path, bodies, skin.faces, skin.mirror, subjects=[0] * 71, poses=list(poses))


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else quantised.SHAPES
    full, small = build_skins()
    print(f"skins of {len(full.mirror):,} and {len(small.mirror):,} vertices")
    sculptor = Sculptor()
    build_people(sculptor, small, folder / "humans_100x6890.npz")
    build_poses(sculptor, full, folder / "poses_71x12166.npz")


if __name__ == "__main__":
    main()
