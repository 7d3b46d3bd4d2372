"""The furniture kinds of the stand-ins are those that the method's vocabulary knows, and as large."""

from wm.offline.furniture import KINDS
from wm.offline.reconstruction.kinds import kind_of
from wm.synth.lifting.vocabulary import LARGEST


def test_kinds_have_the_names_and_the_largest_sizes_of_the_vocabulary():
    assert {name: kind.high for name, kind in KINDS.items()} == LARGEST


def test_every_kind_stands_for_its_own_name():
    assert all(kind_of(name) == name for name in KINDS)
