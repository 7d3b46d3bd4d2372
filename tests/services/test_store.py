"""The store of answers: what is kept comes back, what is damaged is as if it were not there, one asks at a time."""

import shutil
import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.services.faults import ServiceError
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
    kept, whole = store.get(key), store.path(key).read_bytes()
    assert kept is not None
    for cut in range(0, len(whole), 7):
        store.path(key).write_bytes(whole[:cut])
        assert store.get(key) is None
    for place in range(len(whole)):
        for flip in (8, 255):
            store.path(key).write_bytes(whole[:place] + bytes([whole[place] ^ flip]) + whole[place + 1 :])
            found = store.get(key)  # the time of a member, for one, changes nothing
            assert found is None or (dict(found[0].files), found[0].record) == (dict(kept[0].files), kept[0].record)


def test_an_answer_that_cannot_be_read_is_not_one_that_is_not_there(tmp_path):
    """It was paid: to ask again because of a permission, or of too many open files, would be to pay again."""
    store, key = AnswerStore(tmp_path), request().key
    store.path(key).mkdir(parents=True)  # stands for them, since a superuser may read everything
    with pytest.raises(ServiceError, match=rf"{key}.zip: answers cannot be kept or read here"):
        store.get(key)


def test_a_file_in_place_of_the_folder_is_an_error_that_names_the_setting(tmp_path):
    (tmp_path / "answers").write_text("")
    with pytest.raises(ServiceError, match=r"answers\.folder=FOLDER"):
        AnswerStore(tmp_path / "answers").get(request().key)
    with pytest.raises(ServiceError, match=r"answers\.folder=FOLDER"), AnswerStore(tmp_path / "answers").claim(request().key):
        pytest.fail("a claim where no answer can be kept")


def test_nothing_is_claimed_where_the_disk_is_nearly_full(tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=2**20))
    with pytest.raises(ServiceError, match="No space left on device"), AnswerStore(tmp_path).claim(request().key):
        pytest.fail("a request would be sent whose answer may have no room")


def test_where_files_cannot_be_locked_threads_still_exclude_each_other(tmp_path, monkeypatch):
    monkeypatch.setattr("wm.services.store.fcntl", None)  # as on Windows
    store = AnswerStore(tmp_path)
    with store.claim("ab12"):
        second = threading.Thread(target=lambda: store.claim("ab12").__enter__(), daemon=True)
        second.start()
        second.join(0.05)
        assert second.is_alive()
        assert not list(tmp_path.rglob("*.lock"))
    second.join(30)
    assert not second.is_alive()


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
