"""Laws of CLIP-IQA+ and of the aesthetic score, on random weights."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tests.quality import tiny
from wm.quality.aesthetic import aesthetic, prepared
from wm.quality.attention import attend
from wm.quality.clip_iqa import clip_iqa, encoded_prompts
from wm.quality.image_tower import side_of_vit
from wm.quality.text_tower import prompt_features


def on_device(arrays):
    return {name: jnp.asarray(array) for name, array in arrays.items()}


@pytest.fixture(scope="module")
def rn50():
    return on_device(tiny.rn50())


@pytest.fixture(scope="module")
def encoded(rn50):
    return encoded_prompts(jnp.asarray(tiny.prompts()["ctx"]), rn50)


@pytest.mark.parametrize("size", [(32, 32), (64, 96), (70, 101)])
def test_a_good_photo_for_one_prompt_is_a_bad_one_for_the_other(rn50, encoded, size):
    rgb = tiny.picture(*size).astype(np.float32) / 255
    score = clip_iqa(rgb, encoded, rn50)
    assert 0 < score < 1
    np.testing.assert_allclose(score + clip_iqa(rgb, encoded[::-1], rn50), 1, atol=1e-6)


def test_equal_prompts_give_one_half_and_lengths_do_not_count(rn50, encoded):
    rgb = tiny.picture().astype(np.float32) / 255
    np.testing.assert_allclose(clip_iqa(rgb, encoded[jnp.array([0, 0])], rn50), 0.5, atol=1e-6)
    np.testing.assert_allclose(clip_iqa(rgb, encoded * jnp.array([[3.0], [0.2]]), rn50), clip_iqa(rgb, encoded, rn50), atol=1e-6)


def test_the_temperature_sharpens_the_score(rn50, encoded):
    rgb = tiny.picture().astype(np.float32) / 255
    odds = [
        float(jax.scipy.special.logit(clip_iqa(rgb, encoded, rn50 | {"logit_scale": jnp.float32(np.log(scale))})))
        for scale in (2.0, 6.0)
    ]
    np.testing.assert_allclose(odds[1] / odds[0], 3, rtol=1e-3)  # the odds are exp(scale * difference of the cosines)


def test_each_prompt_depends_on_its_own_vectors(rn50):
    context = jnp.asarray(tiny.prompts()["ctx"])
    before, after = prompt_features(context, rn50), prompt_features(context.at[1, 15, 0].add(3), rn50)
    np.testing.assert_array_equal(before[0], after[0])
    assert jnp.abs(before[1] - after[1]).max() > 1e-3  # the last vector stands before END, which looks back


@pytest.mark.parametrize(("keys", "queries", "width", "causal"), [(1, 1, 32, False), (5, 3, 128, False), (4, 4, 128, True)])
def test_attention_is_a_mean_of_values_weighted_in_each_head(keys, queries, width, causal):
    rng = np.random.default_rng(keys)
    q, k, v = (rng.standard_normal((count, width)) for count in (queries, keys, keys))
    seen = np.tri(queries, keys, dtype=bool) if causal else np.ones((queries, keys), bool)
    wanted, size = np.zeros((queries, width)), min(width, 64)
    for head in range(max(width // 64, 1)):
        part = slice(head * size, (head + 1) * size)
        for i in range(queries):
            weights = np.exp([q[i, part] @ k[j, part] / np.sqrt(size) if seen[i, j] else -np.inf for j in range(keys)])
            wanted[i, part] = weights @ v[:, part] / weights.sum()
    found = attend(*(jnp.asarray(x, jnp.float32) for x in (q, k, v)), jnp.asarray(seen))
    np.testing.assert_allclose(found, wanted, atol=2e-5)


def test_maps_one_after_another_are_one_map():
    weights, head = on_device(tiny.vit_l14()), tiny.head()
    matrix, shift = np.eye(tiny.EMBEDDING), np.zeros(tiny.EMBEDDING)
    for k in (0, 2, 7):
        matrix, shift = head[f"layers.{k}.weight"] @ matrix, head[f"layers.{k}.weight"] @ shift + head[f"layers.{k}.bias"]
    single = {"weight": jnp.asarray(matrix, jnp.float32), "bias": jnp.asarray(shift, jnp.float32)}
    image = prepared(tiny.picture(), side_of_vit(weights))
    np.testing.assert_allclose(aesthetic(image, weights, on_device(head)), aesthetic(image, weights, single), atol=1e-5)


def test_an_image_is_cut_in_its_middle_and_not_stretched():
    square = tiny.picture(48, 48)
    wide = np.concatenate([np.zeros((48, 20, 3), np.uint8), square, np.zeros((48, 20, 3), np.uint8)], axis=1)
    for image in (square, wide, wide.transpose(1, 0, 2)):
        cut = prepared(image, 48)
        wanted = square if image.shape[0] == 48 else square.transpose(1, 0, 2)
        np.testing.assert_array_equal(cut, wanted.astype(np.float32) / 255)
    assert prepared(tiny.picture(70, 101), 32).shape == (32, 32, 3) == prepared(tiny.picture(9, 300), 32).shape


def test_a_plain_image_keeps_its_colour_at_any_size():
    np.testing.assert_allclose(prepared(np.full((37, 91, 3), 102, np.uint8), 32), np.full((32, 32, 3), 0.4), atol=1e-6)
