"""Stage `heldout`: the true image of each held-out view, where the image backend knows its world."""

import dataclasses

import numpy as np

from wm import codecs
from wm.color import to_bytes
from wm.stages.ordered import in_order
from wm.stages.run_context import RunContext
from wm.stages.scene import Scene
from wm.synth.backends import ImageBackend, WorldBackend
from wm.synth.checked import checked_image
from wm.synth.registry import backend_key
from wm.types import View


@dataclasses.dataclass(frozen=True, eq=False)
class HeldOut:
    """Where the true images are in the run folder."""

    known: bool  # whether the image backend knows its world
    key: str
    run: RunContext

    def truth(self, view: View) -> np.ndarray:
        """[h, w, 3] uint8: the true image of a held-out view."""
        return codecs.decode_png((self.run.folder.path / _file(view)).read_bytes())


def render_heldout(run: RunContext, scene: Scene, image: ImageBackend) -> HeldOut:
    """Stores the true images of all held-out views. Only a `WorldBackend` has any; a real image model has none."""
    config = run.config
    drawn = (config.cameras, config.finish, config.light)
    key = run.key("heldout", scene.key, config.scene.theme, *drawn, *backend_key(config.image))
    with run.stage("heldout"):
        if not isinstance(image, WorldBackend):
            return HeldOut(known=False, key=key, run=run)
        wanted = [view for view in scene.heldout if not run.folder.has(_name(view), key)]
        run.folder.drop_others("heldout/", {_name(view) for view in scene.heldout})
        with run.bar("heldout", len(wanted)) as bar:
            for view, rgb in zip(wanted, in_order(image.truth, wanted)):
                run.folder.save(_name(view), key, {_file(view): codecs.encode_png(to_bytes(checked_image(rgb, view)))})
                bar.update()
    return HeldOut(known=True, key=key, run=run)


def _name(view: View) -> str:
    return f"heldout/{view.name}"


def _file(view: View) -> str:
    return f"heldout/{view.name}.truth.png"
