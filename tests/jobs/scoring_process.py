"""A process that scores submissions until it is killed, as a server does: DATABASE_URL DATA_DIR."""

from __future__ import annotations

import signal
import sys
from pathlib import Path


def main() -> None:
    # a worker imports this file too: what only the server needs is imported here
    from datetime import UTC, datetime

    from gated_scoring import gated_score, gated_validate

    from app.db.session import open_database
    from app.jobs.dispatcher import Dispatcher
    from app.jobs.work import Tasks
    from app.settings import Settings
    from app.storage import open_blobs

    address, folder = sys.argv[1:]
    settings = Settings(data_dir=Path(folder), workers=1, heartbeat_seconds=0.5, max_attempts=3)
    dispatcher = Dispatcher(
        open_database(address),
        open_blobs(settings),
        settings,
        lambda: datetime.now(UTC),
        tasks=Tasks(score=gated_score, validate=gated_validate),
    )
    dispatcher.start()
    signal.sigwait([signal.SIGTERM])
    dispatcher.stop()


if __name__ == "__main__":
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
    main()
