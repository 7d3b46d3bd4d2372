"""What a model costs, by the table of conf/prices. Prices are what services announced on the table's date, in US dollars."""

import dataclasses
from collections.abc import Mapping

from wm.bounds import number, setting


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Price:
    """What one model costs. A part that the service does not charge for is 0."""

    input: float = number(0.0, 0, 1e6, "Per million input tokens.", unit="USD")
    output: float = number(0.0, 0, 1e6, "Per million output tokens.", unit="USD")
    image_tokens: float = number(0.0, 0, 1e6, "Per million tokens of images put out.", unit="USD")
    image: float = number(0.0, 0, 1e6, "Per image put out.", unit="USD")
    request: float = number(0.0, 0, 1e6, "Per request.", unit="USD")
    usage: dict[str, float] = dataclasses.field(
        default_factory=dict, hash=False, metadata={"help": "Tokens and images of a typical request, for estimates."}
    )
    seconds: float | None = number(None, 0.0, 1e5, "Time of a typical request.", unit="s", null="not known")
    source: str = setting("", "Where the price was read.")

    def cost(self, usage: Mapping[str, int | float]) -> float:
        """USD of a request that used this; what is not said is not charged."""
        tokens = (
            usage.get("input_tokens", 0) * self.input
            + usage.get("output_tokens", 0) * self.output
            + usage.get("image_tokens", 0) * self.image_tokens
        )
        return tokens / 1e6 + usage.get("images", 0) * self.image + self.request


@dataclasses.dataclass(frozen=True, kw_only=True)
class Prices:
    """A table of prices."""

    as_of: str = ""  # the day on which its prices were read
    models: Mapping[str, Price] = dataclasses.field(default_factory=dict)

    def of(self, model: str) -> Price | None:
        """The price of a model: that of the longest name in the table that the model's name begins with."""
        names = [name for name in self.models if model.startswith(name)]
        return self.models[max(names, key=len)] if names else None

    def cost(self, model: str, usage: Mapping[str, int | float]) -> float | None:
        """USD of a request that used this; None if the table has no price for the model."""
        price = self.of(model)
        return None if price is None else price.cost(usage)

    def expected(self, model: str, usage: Mapping[str, int | float] | None = None) -> float | None:
        """USD of a request before it is sent; `usage` overrides what is typical of the model."""
        price = self.of(model)
        return None if price is None else price.cost({**price.usage, **(usage or {})})
