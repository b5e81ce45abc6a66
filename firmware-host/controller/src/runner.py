"""Serves a controller in Python to the host at the other end of standard input."""
import os
import signal
import struct
import sys
import traceback
import types


def serve(path):
    # Whoever interrupts the host ends this process by the end of the socket.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    host = os.dup(0)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)

    def read(count):
        data = os.read(host, count)
        while len(data) < count:
            more = os.read(host, count - len(data))
            if not more:
                return b""
            data += more
        return data

    def numbers(layout):
        return struct.unpack("<" + layout, read(struct.calcsize("<" + layout)))

    def answer(data, kind=0):
        data = struct.pack("<II", kind, len(data)) + data
        while data:
            data = data[os.write(host, data):]

    def failed(text):
        answer(text.encode()[: 1 << 20], 1)

    def raised(error):
        # Without the frame of this program.
        lines = traceback.format_exception(type(error), error, error.__traceback__.tb_next)
        failed("raised an exception\n" + "".join(lines).rstrip())

    _, sensors, magnets, parameters = numbers("4I")
    scene = types.SimpleNamespace(period_s=numbers("d")[0], sensors=sensors, magnets=magnets)
    scene.magnet_plane = list(numbers("%dI" % magnets))
    scene.force_max_n = list(numbers("%dd" % magnets))
    scene.parameters = list(numbers("%dd" % parameters))

    module = types.ModuleType("controller")
    module.__file__ = path
    sys.modules["controller"] = module
    sys.path[0] = os.path.dirname(path)
    sys.argv = [path]
    try:
        with open(path, "rb") as file:
            exec(compile(file.read(), path, "exec"), module.__dict__)
        if not callable(getattr(module, "make", None)):
            return failed("has no function make(scene)")
        controller = module.make(scene)
        step = getattr(controller, "step", None)
        if not callable(step):
            return failed("make(scene) returned %r, which has no method step(sample)" % (controller,))
    except BaseException as error:
        return raised(error)
    answer(b"")

    sample = struct.Struct("<ddI%dI%dd" % (sensors, 2 * sensors))
    forces = struct.Struct("<%dd" % (2 * magnets))
    while True:
        data = read(sample.size)
        if not data:
            break
        t_s, spin_rad_s, hold, *rest = sample.unpack(data)
        now = types.SimpleNamespace(
            t_s=t_s,
            spin_rad_s=spin_rad_s,
            hold=bool(hold),
            sequence=rest[:sensors],
            position_m=rest[sensors:],
        )
        try:
            returned = step(now)
            try:
                forces_n = [float(force) for force in returned]
            except (TypeError, ValueError):
                failed("step returned %r, expected a list of %d forces" % (returned, 2 * magnets))
                continue
            if len(forces_n) != 2 * magnets:
                failed(
                    "step returned %d forces, expected %d: x and y of each of %d magnets"
                    % (len(forces_n), 2 * magnets, magnets)
                )
                continue
        except BaseException as error:
            raised(error)
            continue
        answer(forces.pack(*forces_n))
    close = getattr(controller, "close", None)
    if callable(close):
        close()


serve(sys.argv[1])
