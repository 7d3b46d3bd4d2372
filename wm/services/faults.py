"""What can go wrong with a request to a model, told apart by what helps."""

from wm.errors import InputError


class TransientError(Exception):
    """The same request may succeed in a while: too many requests, an overloaded or absent server, a cut connection, a timeout, a
    reply that is not the service's (HTML in place of JSON), a worker process that died.

    Args:
      message: what was seen, without secrets and without the request.
      after: seconds that the service asks to wait (Retry-After); None if it says nothing.
    """

    def __init__(self, message: str, *, after: float | None = None):
        super().__init__(message)
        self.after = after


class RefusedError(Exception):
    """The model answered, and gave nothing that can be used: a safety refusal, an empty candidate, a text in place of an image, a
    cut text, an image that cannot be read, depth that is not finite. Another seed or prompt may help; the same request does not.

    Callers count it as a failed attempt. The answer is kept like any other, so that it is not paid twice.
    """


class ServiceError(RuntimeError):
    """A model cannot be reached or does not accept the request, and waiting does not help; the message says what would."""


class BudgetError(ServiceError):
    """The next request would exceed `budget.usd` or `budget.requests`. Nothing was sent."""


class ReplayError(ServiceError):
    """`answers.replay=only` and the store has no answer to a request. Nothing was sent."""


class MissingExtraError(InputError):
    """A backend needs a package that is not installed; the message names the extra of wm that installs it."""


class MissingKeyError(InputError):
    """A backend needs a secret that the environment does not hold; the message names the variable, never a value."""
