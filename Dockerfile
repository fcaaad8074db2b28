# One image for all: server, scheduler and worker. See docker-compose.yml for how it is meant to be started, and
# docker-compose.small.yml for one process that is all of it.
FROM python:3.12-slim AS build
WORKDIR /source
COPY . .
# slim has no C compiler: the build fetches the wheel ziglang, which stays in this stage
RUN pip install --no-cache-dir build \
 && python -m build --wheel --outdir /wheels

FROM python:3.12-slim
COPY requirements.lock /tmp/requirements.lock
COPY --from=build /wheels /wheels
# the lock file pins what the wheel needs; its hashes can't cover the wheel itself, so it is stripped to constraints
RUN sed -E 's/ \\$//; /^ +--hash/d' /tmp/requirements.lock > /tmp/constraints.txt \
 && pip install --no-cache-dir --constraint /tmp/constraints.txt "$(echo /wheels/*.whl)[cluster,oidc,postgres,s3]" \
 && rm -r /wheels /tmp/requirements.lock /tmp/constraints.txt \
 && useradd --create-home --uid 10001 clearlines \
 && install -d -o clearlines /data
USER clearlines
# no VOLUME: scheduler and workers keep nothing, and each of their containers would leave an empty one behind
ENV CLEARLINES_DATA_DIR=/data
EXPOSE 8765
# of a server; the other commands have theirs in docker-compose.yml
HEALTHCHECK --interval=10s --timeout=3s --start-period=20s \
  CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8765/api/health', timeout=2)"]
CMD ["clearlines", "serve", "--port", "8765", "--no-browser"]
