"""Ports of the loopback that nobody uses."""

import socket


def free_port(kind=socket.SOCK_DGRAM):
    while True:
        with socket.socket(socket.AF_INET, kind) as one:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
        if kind == socket.SOCK_STREAM or port % 2 == 0:  # as RTP has them
            return port
