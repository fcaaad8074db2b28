"""Whether a worker may be given work: asked when it joins, and again while it can't tell or works for others."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from distributed import Client
from distributed.comm.core import CommClosedError

from app.jobs.cluster.members import Member
from app.jobs.cluster.tasks import introduce
from app.jobs.cluster.versions import difference

ADMIT_SECONDS = 30.0
FULL = 0.8
"""A worker that holds this share of what its nanny allows is replaced before the nanny ends it in its work."""
BUSY = "it is busy with work of another server, or of one that ended"


@dataclass(frozen=True)
class Admission:
    """What a server asks of its workers.

    Attributes:
        versions: ``installed_versions`` of the server.
        megabytes: A worker that holds more after a task is replaced; the nanny's bound alone counts where it is unset.
    """

    versions: Mapping[str, str]
    megabytes: int | None

    async def examine(self, client: Client, member: Member) -> bool:
        """Ask a worker who it is, and set why it isn't given work, if so.

        Args:
            client: Connected to the scheduler.
            member: The worker; its name, memory and bounds are set too.

        Returns:
            Whether to ask again later: what stands in its way may pass.
        """
        try:
            told = await introduced(client, member.address)
        except (OSError, CommClosedError, KeyError) as error:
            member.reason = f"it doesn't answer: {error or type(error).__name__}"
            return True
        except Exception as error:  # it may raise anything, having another version
            member.reason = f"another version of ClearLines is installed there, or none: {error}"
            return False
        member.name, member.megabytes = told["name"], told["megabytes"]
        bounds = [self.megabytes, told["limit"] and FULL * told["limit"]]
        member.most_megabytes = min((bound for bound in bounds if bound), default=None)
        member.reason = difference(self.versions, told["versions"])
        if member.reason is None and told["threads"] != 1:
            member.reason = "it has several threads in one process; start it with `clearlines worker`"
        if member.reason is None and told["executing"]:
            member.reason = BUSY
            return True
        return False


async def introduced(client: Client, address: str) -> dict[str, Any]:
    """Return what a worker tells of itself.

    Raises:
        OSError, CommClosedError, KeyError: When it doesn't answer, or is gone.
    """
    answers = await wait_at_most(client.run(introduce, workers=[address]))
    return answers[address]


async def wait_at_most(answer: Any) -> Any:
    """Wait for an answer of the cluster; of any type, as Dask's own don't know that its client may be asynchronous."""
    async with asyncio.timeout(ADMIT_SECONDS):
        return await answer
