"""The store of answers: what is kept comes back, what is damaged is as if it were not there, one asks at a time."""

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.services.records import ServiceAnswer, ServiceRequest
from wm.services.store import AnswerStore

names = st.text(st.characters(categories=("Ll", "Nd")), min_size=1, max_size=8).map(lambda name: f"{name}.bin")


def request(**content) -> ServiceRequest:
    return ServiceRequest(backend="lab", model="m-1", content=content)


@settings(max_examples=25, deadline=None)
@given(files=st.dictionaries(names, st.binary(max_size=200), max_size=3), refusal=st.text(max_size=20))
def test_what_is_kept_comes_back(tmp_path_factory, files, refusal):
    store = AnswerStore(tmp_path_factory.mktemp("answers"))
    answer = ServiceAnswer(files=files, refusal=refusal, model_version="7", usage={"input_tokens": 3})
    store.put(request(prompt="x"), answer, {"usd": 0.5})
    kept = store.get(request(prompt="x").key)
    assert kept is not None
    assert dict(kept[0].files) == files and kept[0].record == answer.record and kept[1] == {"usd": 0.5}


def test_equal_answers_are_equal_files(tmp_path):
    for name in ("a", "b"):
        AnswerStore(tmp_path / name).put(request(seed=1), ServiceAnswer(files={"text.txt": b"hello"}), {})
    key = request(seed=1).key
    assert AnswerStore(tmp_path / "a").path(key).read_bytes() == AnswerStore(tmp_path / "b").path(key).read_bytes()


def test_the_key_is_that_of_model_and_content():
    image = np.zeros((2, 3), np.float32)
    same = request(prompt="x", image=image, seed=1)
    assert same.key == request(seed=1, image=image.copy(), prompt="x").key
    others = [request(prompt="y", image=image, seed=1), request(prompt="x", image=image + 1, seed=1)]
    others.append(request(prompt="x", image=image))
    others += [request(prompt="x", image=image.T, seed=1), request(prompt="x", image=image, seed=2)]
    others.append(ServiceRequest(backend="lab", model="m-2", content=same.content))
    assert len({same.key, *(other.key for other in others)}) == 1 + len(others)
    assert ServiceRequest(backend="elsewhere", model="m-1", content=same.content).key == same.key


def test_every_damage_is_as_if_the_answer_were_not_there(tmp_path):
    store, key = AnswerStore(tmp_path), request().key
    assert store.get(key) is None
    store.put(request(), ServiceAnswer(files={"text.txt": b"some words of an answer"}), {})
    whole = store.path(key).read_bytes()
    for cut in range(0, len(whole), 7):
        store.path(key).write_bytes(whole[:cut])
        assert store.get(key) is None
    flipped = whole.replace(b"some words", b"other word")
    store.path(key).write_bytes(flipped)
    assert store.get(key) is None


@pytest.mark.parametrize("stores", [1, 2])
def test_one_holds_a_key_at_a_time(tmp_path, stores):
    made = [AnswerStore(tmp_path) for _ in range(stores)]  # two stand for two processes: locks of files are by open file
    inside, most, lock = [0], [0], threading.Lock()

    def hold(store: AnswerStore) -> None:
        for _ in range(20):
            with store.claim("ab12"):
                with lock:
                    inside[0] += 1
                    most[0] = max(most[0], inside[0])
                with lock:
                    inside[0] -= 1

    threads = [threading.Thread(target=hold, args=(made[k % stores],)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most[0] == 1
    assert not list(tmp_path.rglob("*.lock"))
