"""What a model costs, by the table of conf/prices. Prices are what services announced on the table's date, in US dollars."""

import dataclasses
from collections.abc import Mapping


@dataclasses.dataclass(frozen=True, kw_only=True)
class Price:
    """Of one model. A part that the service does not charge for is 0."""

    input: float = 0.0  # USD per million input tokens
    output: float = 0.0  # USD per million output tokens
    image_tokens: float = 0.0  # USD per million tokens of images put out
    image: float = 0.0  # USD per image put out
    request: float = 0.0  # USD per request
    usage: Mapping[str, float] = dataclasses.field(default_factory=dict)  # of a typical request (ServiceAnswer.usage)
    seconds: float | None = None  # of a typical request

    def cost(self, usage: Mapping[str, float]) -> float:
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

    def cost(self, model: str, usage: Mapping[str, float]) -> float | None:
        """USD of a request that used this; None if the table has no price for the model."""
        price = self.of(model)
        return None if price is None else price.cost(usage)

    def expected(self, model: str, usage: Mapping[str, float] | None = None) -> float | None:
        """USD of a request before it is sent; `usage` overrides what is typical of the model."""
        price = self.of(model)
        return None if price is None else price.cost({**price.usage, **(usage or {})})
