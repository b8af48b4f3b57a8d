"""One step of a service without a bus: inputs by name, and what it says by name."""


class Said(dict):
    """What is not said is empty: a dict where it goes by vehicle, else a list."""

    def __init__(self, service, outputs):
        super().__init__(outputs.said())
        self._service = service

    def __missing__(self, name):
        topic = self._service.outputs.get(name)
        return {} if topic is not None and topic.per_vehicle and self._service.scope == "world" else []


def stepped(service, t, **inputs):
    return Said(service, service.step(t, service.Inputs(**inputs)))


def stale(service, t, missing):
    return Said(service, service.stale(t, missing))


def recall(service, **left):
    service.recall(service.Recalls(**left))
