"""Our CLIP-IQA+ and aesthetic score against IQA-PyTorch's (pyiqa), on the same weights and images.

    python experiments/quality/compare.py [FOLDER]

FOLDER holds weights as `evaluate.quality` reads them; without it random ones in miniature are compared. Needs torch, safetensors
and pyiqa. pyiqa's licence (PolyForm Noncommercial) forbids commercial use, so it is no dependency of wm and runs here alone.
"""

import pathlib
import sys
import tempfile

import numpy as np
import torch
from pyiqa.archs import clip_model, clipiqa_arch
from pyiqa.archs.laion_aes_arch import LAIONAes
from safetensors.numpy import save_file
from safetensors.torch import load_file
from tabulate import tabulate

sys.path.insert(0, str(pathlib.Path(__file__).parents[2]))

from tests.quality import tiny
from wm.quality import open_quality
from wm.quality.aesthetic import maps_of
from wm.quality.weights import FILES, HEAD, PROMPTS, RN50, VIT_L14

CONTEXT = 77
"""Positions of a text in CLIP's tokenizer, to which pyiqa fills all prompts."""


def miniature(folder: pathlib.Path) -> pathlib.Path:
    """Random weights whose tables are as long as pyiqa's tokenizer wants, in the precision to which it rounds."""
    rng = np.random.default_rng(7)
    rn50, vit = tiny.rn50(), tiny.vit_l14()
    for arrays in (rn50, vit):
        arrays["positional_embedding"] = tiny.drawn(rng, CONTEXT, tiny.WIDTH, scale=0.5)
    rn50["visual.attnpool.positional_embedding"] = tiny.drawn(rng, 50, 32 * tiny.STEM)
    for name, arrays in zip(FILES, (rn50, tiny.prompts(), vit, tiny.head())):
        save_file({key: np.array(array, np.float16) for key, array in arrays.items()}, folder / name)
    return folder


def their_iqa(folder: pathlib.Path) -> torch.nn.Module:
    clipiqa_arch.load = lambda *_: clip_model.build_model(load_file(folder / RN50)).float().eval()  # in place of a download
    model = clipiqa_arch.CLIPIQA(model_type="clipiqa+", pretrained=False)
    model.prompt_learner.ctx.data = load_file(folder / PROMPTS)["ctx"].float()
    return model.eval()


def their_aesthetic(folder: pathlib.Path) -> LAIONAes:
    """Their model with our weights in place of those that it would download."""
    model = LAIONAes.__new__(LAIONAes)
    torch.nn.Module.__init__(model)
    model.clip_model = [_WithPositions(clip_model.build_model(load_file(folder / VIT_L14)).float().eval())]
    weights = load_file(folder / HEAD)
    model.mlp = torch.nn.Sequential(*(_linear(weights, name) for name in maps_of(weights)))
    return model.eval()


class _WithPositions(torch.nn.Module):
    """pyiqa's copy of CLIP, which leaves the embedding of positions out unless it is told, told so as OpenAI's CLIP does it."""

    def __init__(self, clip: torch.nn.Module):
        super().__init__()
        self.clip, self.visual = clip, clip.visual

    def encode_image(self, image: torch.Tensor) -> torch.Tensor:
        return self.clip.visual(image, pos_embedding=True)


def _linear(weights: dict[str, torch.Tensor], name: str) -> torch.nn.Linear:
    weight = weights[f"{name}weight"]
    layer = torch.nn.Linear(weight.shape[1], weight.shape[0])
    layer.load_state_dict({part: weights[f"{name}{part}"].float() for part in ("weight", "bias")})
    return layer


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary, torch.no_grad():
        folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else miniature(pathlib.Path(temporary))
        iqa, marks, ours = their_iqa(folder), their_aesthetic(folder), open_quality(str(folder))
        rows = []
        for name, rgb in pictures().items():
            x = torch.from_numpy(rgb).permute(2, 0, 1)[None].float() / 255
            own = ours.score(rgb)
            rows.append((name, own["clip_iqa"], iqa(x).item(), own["aesthetic"], marks(x).item()))
    print(tabulate(rows, ("image", "IQA+ ours", "pyiqa", "aesthetic ours", "pyiqa"), tablefmt="github", floatfmt=".6f"))


def pictures() -> dict[str, np.ndarray]:
    ramp = np.linspace(0, 255, 96)[None, :, None] * np.ones((64, 1, 3))
    return {
        "noise 32 x 32": tiny.picture(32, 32),
        "noise 70 x 101": tiny.picture(70, 101),
        "noise 384 x 688": tiny.picture(384, 688),
        "ramp 64 x 96": ramp.round().astype(np.uint8),
    }


if __name__ == "__main__":
    main()
