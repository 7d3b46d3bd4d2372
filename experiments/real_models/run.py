"""The paper's models in one run, without a key or weights: loopback services and checkpoints with random weights.

    python -m pip install -e '.[gemini,anthropic,diffusers,sam,depth,sam3d,test]'
    python experiments/real_models/run.py                          # gothic at draft, a folder of its own below outputs/
    python experiments/real_models/run.py scene.rooms=[hall,study] until=furnish

It starts two servers on this machine that speak the services' own wire format (one draws what it is sent, one answers with floor
plans and names), writes the checkpoints, and runs the command that it prints: all backends are the real ones. What comes out
looks like its condition at best, since nothing here has learned anything; what is shown is that everything fits together.
"""

import argparse
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from collections.abc import Iterator

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.models import tiny  # noqa: E402
from tests.models.image.drawing_servers import drawing, gemini_reply  # noqa: E402
from tests.models.language.wire import claude_reply  # noqa: E402
from tests.models.loopback import Asked, Loopback, Reply  # noqa: E402
from wm.offline.language.grammar import Grammar  # noqa: E402
from wm.run import load_config  # noqa: E402

CHOSEN = (
    "image=nano_banana_pro", "language=claude", "objects=lifted", "segmentation=sam3_text", "reconstruction=sam3d_objects",
    "depth=depth_pro", "preset=draft",
)  # fmt: skip
"""The paper's models."""
WORKER = ROOT / "wm/models/reconstruction/example_worker.py"


def speaking(theme: str, rooms: list[str]):
    """What a server answers that is asked for floor plans, and for names of things."""
    plan = Grammar().propose(theme, rooms, seed=0, violations=[], previous=None).text

    def answer(asked: Asked) -> Reply:
        named = "things" in json.dumps(asked.json.get("output_config", {}))
        return claude_reply(json.dumps({"things": ["sofa", "table", "lamp", "bookcase"]}) if named else plan)

    return answer


@contextlib.contextmanager
def services(scene: str, more: list[str]) -> Iterator[list[str]]:
    """Both servers, for as long as the block lasts; gives the arguments that name them and the local models."""
    config = load_config([scene, *[argument for argument in more if argument.startswith("scene.")]])
    with Loopback(drawing(gemini_reply)) as painter, Loopback(speaking(config.scene.theme, list(config.scene.rooms))) as writer:
        yield [
            f"image.base_url={painter.url}",
            f"language.base_url={writer.url}",
            f"segmentation.model={tiny.checkpoint('sam3')}",
            f"depth.model={tiny.checkpoint('depth_pro')}",
            f"reconstruction.python={sys.executable}",
            f"reconstruction.script={WORKER}",
            "verify.max_attempts=2",  # nothing passes: the depth of random weights is noise
        ]


def run(more: list[str]) -> int:
    """Runs the command against the servers; its exit code."""
    scene = next((argument for argument in more if argument.startswith("+scene=")), "+scene=gothic")
    more = [argument for argument in more if argument != scene]
    with services(scene, more) as where:
        command = [sys.executable, "-m", "wm.run", scene, *CHOSEN, *where, *more]
        print(" ".join(command[1:]), flush=True)
        secrets = {"GEMINI_API_KEY": "not-a-key", "ANTHROPIC_API_KEY": "not-a-key"}
        offline = {"HF_HUB_OFFLINE": "1", "PYTHONPATH": str(ROOT)}
        return subprocess.run(command, env=os.environ | secrets | offline, check=False).returncode


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("arguments", nargs="*", help="further arguments of wm")
    more = parser.parse_args().arguments
    with tempfile.TemporaryDirectory() as answers:
        own = [f"answers.folder={answers}"] * (not any(argument.startswith("answers.folder=") for argument in more))
        sys.exit(run([*own, "output=outputs/real_models", "overwrite=true", *more]))


if __name__ == "__main__":
    main()
