"""A node whose callbacks a test calls."""

from types import SimpleNamespace


class Node:
    #: Values of parameters, by their names.
    given = {}

    def __init__(self, name):
        self.name, self.subscriptions_by_topic, self.published, self.timers_by_period = name, {}, {}, {}

    def declare_parameter(self, name, default):
        return SimpleNamespace(value=self.given.get(name, default))

    def create_publisher(self, kind, topic, depth):
        messages = self.published.setdefault(topic, [])

        def publish(message):
            assert isinstance(message, kind)
            messages.append(message)

        return SimpleNamespace(publish=publish)

    def create_subscription(self, kind, topic, callback, depth):
        def receive(message):
            assert isinstance(message, kind)
            callback(message)

        self.subscriptions_by_topic[topic] = receive

    def create_timer(self, period_s, callback):
        self.timers_by_period[period_s] = callback
