"""A process that calibrates until it is killed, as a server does: DATABASE_URL DATA_DIR."""

from __future__ import annotations

import signal
import sys
from pathlib import Path


def main() -> None:
    # a worker imports this file too: what only the server needs is imported here
    from datetime import UTC, datetime

    from gated_calibrations import gated_calibrate

    from app.db.session import open_database
    from app.jobs.dispatcher import Dispatcher
    from app.jobs.work import Tasks
    from app.settings import Settings
    from app.storage import open_blobs

    address, folder = sys.argv[1:]
    settings = Settings(data_dir=Path(folder), workers=1, heartbeat_seconds=0.3, max_attempts=3)
    dispatcher = Dispatcher(
        open_database(address),
        open_blobs(settings),
        settings,
        lambda: datetime.now(UTC),
        tasks=Tasks(calibrate=gated_calibrate),
    )
    dispatcher.start()
    signal.sigwait([signal.SIGTERM])
    dispatcher.stop()


if __name__ == "__main__":
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
    main()
