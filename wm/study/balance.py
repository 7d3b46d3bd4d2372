"""Who sees what: every item equally often, for any number of participants.

Items are dealt like cards. A deck is dealt to its end before a card comes again, so after any number of participants two items
differ by at most one showing, also where the last ones never came. Items are grouped in strata (the scenes of one method, or of
one pair of methods): each participant gets equally many of each stratum, or one more, and these extra ones are dealt from a deck
too. That is a balanced incomplete block design for any numbers, and the complete one where everybody sees everything.
"""

import random
from collections.abc import Hashable, Sequence
from typing import Generic, TypeVar

Card = TypeVar("Card", bound=Hashable)


class Deck(Generic[Card]):
    """An endless deck: all its cards in a random order, then all of them again in another."""

    def __init__(self, cards: Sequence[Card], rng: random.Random):
        self._cards, self._rng = tuple(cards), rng
        self._left: list[Card] = []

    def take(self, number: int) -> list[Card]:
        """The next cards, all different.

        Raises:
          ValueError: so many different cards are not in the deck.
        """
        if number > len(self._cards):
            raise ValueError(f"{number} different cards of {len(self._cards)}")
        hand: list[Card] = []
        while len(hand) < number:
            if not self._left:
                self._shuffle(hand)
            hand.append(self._left.pop())
        return hand

    def _shuffle(self, hand: list[Card]) -> None:
        """All cards again; those in the hand come last, so that it gets none of them twice."""
        mixed = self._rng.sample(self._cards, len(self._cards))
        self._left = [card for card in mixed if card in hand] + [card for card in mixed if card not in hand]


def dealt(strata: Sequence[Sequence[Card]], each: int, hands: int, rng: random.Random) -> list[list[Card]]:
    """`hands` hands of `each` different items.

    Args:
      strata: groups of items, equally many in each, no item twice.
      each: items of a hand; at most as many as there are.

    Returns:
      The hands. In the first k of them, for every k, two items (and two strata) differ by at most one showing; within a hand two
      strata differ by at most one item.
    """
    decks = [Deck(stratum, rng) for stratum in strata]
    turns = Deck(range(len(strata)), rng)
    common, extra = divmod(each, len(strata)) if strata else (0, 0)
    dealt_hands = []
    for _ in range(hands):
        more = turns.take(extra)
        dealt_hands.append([card for number, deck in enumerate(decks) for card in deck.take(common + (number in more))])
    return dealt_hands


class Sides(Generic[Card]):
    """On which side the first of a pair stands: it changes with each showing, and half of the items of a stratum begin left."""

    def __init__(self, strata: Sequence[Sequence[Card]], rng: random.Random):
        self._left: dict[Card, bool] = {}
        for stratum in strata:
            first = rng.random() < 0.5
            for number, card in enumerate(rng.sample(list(stratum), len(stratum))):
                self._left[card] = (number % 2 == 0) == first

    def next_left(self, card: Card) -> bool:
        """Whether the first of the pair is on the left this time."""
        left = self._left[card]
        self._left[card] = not left
        return left
