# One image for every service: docker-compose.yml says which command each container runs.
FROM python:3.11-slim-bookworm

WORKDIR /uvf
COPY requirements.lock ./
# Only pybullet has no wheel for ARM: there, and only there, it is compiled.
RUN if [ "$(dpkg --print-architecture)" != amd64 ]; then \
        apt-get update && apt-get install -y --no-install-recommends g++ && rm -rf /var/lib/apt/lists/*; \
    fi \
    && pip install --no-cache-dir --require-hashes -r requirements.lock

COPY . .
ENV PYTHONPATH=/uvf:/uvf/src PYTHONUNBUFFERED=1 UVF_RUNS=/runs
# Generates the MAVLink dialect into the image: its containers may be read-only.
RUN python -c "from uvf.mavlink import dialect"
# Compiles the numerical kernels into the image, so that containers start warm.
RUN python -m launch.cli check
ENTRYPOINT ["python", "-m", "launch.cli"]
CMD ["--help"]

# The main loop of the supervised process touches its file each second; one that was given up no longer does.
HEALTHCHECK --interval=5s --timeout=3s --start-period=60s --retries=3 \
    CMD find /tmp -name "*.alive" -newermt "5 seconds ago" | grep -q .
