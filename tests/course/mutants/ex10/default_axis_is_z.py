# loses: 10.1
# Takes z for the axis of a joint that names none.
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    description = _describe(urdf)
    for joint, found in zip(root.findall("joint"), description["joints"], strict=True):
        if joint.find("axis") is None:
            found["axis"] = [0.0, 0.0, 1.0]
    return description
