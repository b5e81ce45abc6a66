"""The shared library by nothing but Python's own ctypes: ten ticks of a rotor towards the wall.

Runs beside a folder that `supervisor/capi/prebuilt/build amb_supervisor` has made.
"""

import ctypes
import re

FLOAT2 = ctypes.c_float * 2

class Sample(ctypes.Structure):
    _fields_ = [("sequence", ctypes.c_uint32), ("status", ctypes.c_uint32), ("position_m", FLOAT2),
                ("spin_rad_s", ctypes.c_float), ("levitation_n", FLOAT2), ("applied_n", FLOAT2)]

class Command(ctypes.Structure):
    _fields_ = [("force_n", FLOAT2), ("own_n", FLOAT2), ("severity", ctypes.c_float), ("mode", ctypes.c_uint32),
                ("limits", ctypes.c_uint32), ("events", ctypes.c_uint32), ("integrator", ctypes.c_uint32)]

header = open("amb_supervisor/include/amb_supervisor.h").read()
constant = lambda name: int(re.search(rf"#define AMB_{name} (\d+)", header)[1])
library = ctypes.CDLL("amb_supervisor/lib/x86_64-unknown-linux-gnu/libsupervisor_capi.so")
abi = library.amb_abi_version()                      # names end with it
call = lambda name: getattr(library, f"amb_{name}_abi{abi}")
call("mode_name").restype = call("error_text").restype = ctypes.c_char_p

count, size = constant("PARAMETERS"), constant("SUPERVISOR_BYTES")
bearing = (ctypes.c_float * 9)(50e-6, 10, -2e5, 2e-4, 1000, 1.6e-4, 0.15, 1e9, 1e-6)    # as amb_bearing has them
values = (ctypes.c_float * count)()
code = call("config_for_bearing")(bearing, values, ctypes.c_size_t(count))
values[constant("P_CONTINUOUS_FORCE_N")] = 400
values[constant("P_CHECK_FIRST")] = 0                # no machine is there to confirm the numbers
plane = (ctypes.c_uint64 * (size // 8))()            # aligned to 8
code = code or call("init")(plane, ctypes.c_size_t(size), values, ctypes.c_size_t(count))
assert code == 0, call("error_text")(code).decode()

command = Command()
for sequence in range(10):                           # towards the wall with 0.4 m/s
    sample = Sample(sequence, 0b1_0000_0011, FLOAT2(0.4 * 50e-6 * sequence, 0), 1000, FLOAT2(-12.5, 25))
    assert call("tick")(plane, ctypes.byref(sample), ctypes.byref(command)) == 0
    print(sequence, call("mode_name")(command.mode).decode(), *(f"{force:.1f} N" for force in command.force_n))
