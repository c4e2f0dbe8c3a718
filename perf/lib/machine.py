"""What benchmarks say of where they ran; needs no package."""


def cpu_name():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "an unnamed processor"
