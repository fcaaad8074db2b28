"""What the server counts, for Prometheus: a registry of its own for each application, nothing global."""

from __future__ import annotations

from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.process_collector import ProcessCollector

SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0, 60.0)
WORK_SECONDS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
MEDIA_TYPE = CONTENT_TYPE_LATEST


class Metrics:
    """Counters that the parts of one server add to, and a registry that tells them."""

    def __init__(self) -> None:
        self.registry = registry = CollectorRegistry()
        self._requests = Histogram(
            "clearlines_request_seconds",
            "Time that requests took, by the address's template.",
            ("method", "template", "status"),
            buckets=SECONDS,
            registry=registry,
        )
        self._in_flight = Gauge("clearlines_requests_in_flight", "Requests being answered.", registry=registry)
        self._received = Counter("clearlines_upload_bytes", "Bytes of forms with files received.", registry=registry)
        self._failures = Counter("clearlines_sign_in_failures", "Sign-ins that failed.", registry=registry)
        self._work = Histogram(
            "clearlines_work_seconds",
            "Time that work of the dispatcher took, from being sent to a worker until its result came.",
            ("kind", "outcome"),
            buckets=WORK_SECONDS,
            registry=registry,
        )
        ProcessCollector(registry=registry)

    def request_began(self) -> None:
        """Count a request as being answered."""
        self._in_flight.inc()

    def request_ended(self, method: str, template: str, status: int, seconds: float) -> None:
        """Count a request as answered."""
        self._in_flight.dec()
        self._requests.labels(method, template, f"{status // 100}xx").observe(seconds)

    def upload_received(self, size: int) -> None:
        """Count bytes of an upload."""
        self._received.inc(size)

    def sign_in_failed(self) -> None:
        """Count a sign-in that failed."""
        self._failures.inc()

    def work_ended(self, kind: str, outcome: str, seconds: float) -> None:
        """Count work of the dispatcher; safe from any thread."""
        self._work.labels(kind, outcome).observe(seconds)

    def text(self) -> bytes:
        """Return everything in Prometheus's text format."""
        return generate_latest(self.registry)
