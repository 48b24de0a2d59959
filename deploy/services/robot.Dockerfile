# The image of the sensor IO and of the controller of a robot. compose.yaml gives the folder with the program as the build
# context `program`. By itself:
#
#     docker build --file robot.Dockerfile --build-context program=/usr/bin --tag vibrissa-robot .
FROM debian:12.12-slim
COPY --from=program vibrissa-robot /usr/bin/vibrissa-robot
# The command is that of a service: `sensor-io` or `control`, with `--config /etc/vibrissa/array.yaml`.
ENTRYPOINT ["/usr/bin/vibrissa-robot"]
CMD ["--help"]
