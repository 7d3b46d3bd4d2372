"""Turns weights as they are published into the folder that `evaluate.quality` reads. Needs torch and safetensors.

    python experiments/quality/convert.py FOLDER --rn50 RN50.pt --prompts CLIP-IQA+_learned_prompts-603f3273.pth \
        --vit-l14 ViT-L-14.pt --head sac+logos+ava1-l14-linearMSE.pth

Each file may be a pickle, an archive of TorchScript (OpenAI's `.pt`) or safetensors (open_clip's). Pickles are read as weights
only, so that they run no code. README.md says where the files are and what their licences allow.
"""

import argparse
import pathlib

import torch
from safetensors.torch import load_file, save_file

from wm.quality.weights import HEAD, PROMPTS, RN50, VIT_L14


def tensors(file: pathlib.Path) -> dict[str, torch.Tensor]:
    """The weights of a file by name; a single tensor is called "ctx"."""
    if file.suffix == ".safetensors":
        return load_file(file)
    try:
        found = torch.jit.load(file, map_location="cpu").state_dict()
    except RuntimeError:  # no TorchScript
        found = torch.load(file, map_location="cpu", weights_only=True)
    if isinstance(found, torch.Tensor):
        return {"ctx": found}
    return found.get("params", found.get("state_dict", found))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="which is written")
    names = {"rn50": RN50, "prompts": PROMPTS, "vit_l14": VIT_L14, "head": HEAD}
    for option in names:
        parser.add_argument(f"--{option.replace('_', '-')}", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for option, name in names.items():
        if (file := getattr(arguments, option)) is not None:
            save_file({key: x.contiguous() for key, x in tensors(file).items()}, arguments.folder / name)
            print(arguments.folder / name)


if __name__ == "__main__":
    main()
