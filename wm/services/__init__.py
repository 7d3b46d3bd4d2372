"""Requests to models that cost money or minutes: asked at most once, retried where that helps, counted, and bounded.

A backend of a real model hands each request to `Services.ask` together with a function that sends it. `ask` looks the request up
in the store of answers first, holds it against the budget, sends it, retries what may pass by itself, keeps the answer whole
before anyone uses it, and writes down what it cost.

    records   a request, its answer, what a request is expected to cost
    faults    what can go wrong with a request, told apart by what helps
    store     answers by the content of their request, in a folder that runs and machines can share
    retries   waiting between tries: bounded, growing, with jitter, as long as the service asks for
    budget    limits of money and requests
    prices    what a model costs by the table of conf/prices
    ledger    what a run has asked and paid, by stage
    services  `Services`, which ties these together
"""
