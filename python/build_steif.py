"""Builds the wheel of steif for pip (PEP 517) with Python's own library: nothing is fetched for that."""
import base64
import hashlib
import os
import re
import tarfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))


def _project(key):
    with open(os.path.join(HERE, "pyproject.toml"), encoding="utf-8") as file:
        return re.search(r'^%s = "([^"]*)"' % key, file.read(), re.MULTILINE).group(1)


NAME, VERSION = _project("name"), _project("version")
METADATA = ("Metadata-Version: 2.1\nName: %s\nVersion: %s\nSummary: %s\nRequires-Python: %s\n"
            "Requires-Dist: numpy\nLicense: BSD-3-Clause\n"
            % (NAME, VERSION, _project("description"), _project("requires-python")))
WHEEL = "Wheel-Version: 1.0\nGenerator: steif\nRoot-Is-Purelib: true\nTag: py3-none-any\n"


def _modules():
    folder = os.path.join(HERE, NAME)
    return [(NAME + "/" + file, os.path.join(folder, file)) for file in sorted(os.listdir(folder))
            if file.endswith(".py")]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info, record = "%s-%s.dist-info/" % (NAME, VERSION), []
    result = "%s-%s-py3-none-any.whl" % (NAME, VERSION)
    with zipfile.ZipFile(os.path.join(wheel_directory, result), "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(name, data):
            wheel.writestr(name, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append("%s,sha256=%s,%d\n" % (name, digest, len(data)))

        for name, path in _modules():
            with open(path, "rb") as file:
                add(name, file.read())
        add(info + "METADATA", METADATA.encode())
        add(info + "WHEEL", WHEEL.encode())
        wheel.writestr(info + "RECORD", "".join(record) + info + "RECORD,,\n")
    return result


def build_sdist(sdist_directory, config_settings=None):
    top = "%s-%s" % (NAME, VERSION)
    with tarfile.open(os.path.join(sdist_directory, top + ".tar.gz"), "w:gz") as archive:
        for name, path in _modules() + [(file, os.path.join(HERE, file))
                                        for file in ("pyproject.toml", "build_steif.py")]:
            archive.add(path, top + "/" + name)
    return top + ".tar.gz"
