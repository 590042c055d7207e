"""Write a controller as a file of another tool: Python with NumPy, C, ONNX, or TorchScript."""

from __future__ import annotations

import io
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.interface.controller import (
    BEFORE,
    BINARY,
    LINEAR,
    LOGISTIC,
    RELU,
    TANH,
    Controller,
)
from botschool.output import check_output, save_bytes

KINDS = (".py", ".h", ".onnx", ".pt")


def export(controller: Controller, path: Path | str, about: str) -> Path:
    """Write the controller; the ending says what: .py, .h, .onnx or .pt. Return the path.

    about: a line on where it comes from. Raises BotschoolError.
    """
    path = check_output(Path(path), KINDS)
    write = {".py": _python, ".h": _c, ".onnx": _onnx, ".pt": _torch}[path.suffix]
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    save_bytes(path, write(controller, name if name[:1].isalpha() else f"c_{name}", about))
    return path


# --- Python


def _python(c: Controller, name: str, about: str) -> bytes:
    arrays = {"MEAN": c.mean, "DEVIATION": c.deviation, "FACTOR": c.factor, "SHIFT": c.shift}
    step = ["x = (np.asarray(observation, float).ravel() - MEAN) / DEVIATION"]
    step += ["x = np.clip(x, -5, 5)"] * c.clip
    step += ["now = {'inputs': x, **{k + '_before': v for k, v in self.memory.items()}}"]
    for layer in c.layers:
        if layer.name == "output" and c.cells:
            step.append(
                "now['cell'] = now['cell_before'] * now['forget'] + now['candidate'] * now['input']"
            )
            step.append("now['hidden'] = np.tanh(now['cell']) * now['give']")
        arrays[f"{layer.name}_bias".upper()] = layer.bias
        net = [f"{layer.name}_bias".upper()]
        for sender, weights in layer.weights.items():
            arrays[f"{layer.name}_{sender}".upper()] = weights
            net.append(f"{layer.name}_{sender}".upper() + f" @ now['{sender}']")
        step.append(f"now['{layer.name}'] = ACTIVATIONS[{layer.activation}]({' + '.join(net)})")
    step += [f"self.memory = {{k: now[k] for k in {sorted(c.memory)}}}", "y = now['output']"]
    if c.discrete:
        step.append("return int(np.argmax(y))")
    elif c.bins > 1:
        choice = f"np.argmax(y.reshape(-1, {c.bins}), axis=1) / {c.bins - 1}"
        step.append(f"return {c.low!r} + {c.high - c.low!r} * {choice}")
    else:
        step.append("return FACTOR * y + SHIFT")
    numbers = "\n".join(f"{key} = np.array({value.tolist()})" for key, value in arrays.items())
    body = "\n        ".join(step)
    text = f'''"""{about}

controller = Controller(); controller.reset(); action = controller.act(observation)
"""

import numpy as np

{numbers}


def logistic(x):
    return 0.5 * (1 + np.tanh(0.5 * x))


ACTIVATIONS = {{
    1: logistic,
    2: np.tanh,
    3: lambda x: x,
    4: lambda x: np.where(x >= 0.5, 1.0, -1.0),
    5: lambda x: np.maximum(x, 0),
}}


class Controller:
    def __init__(self):
        self.reset()

    def reset(self):
        """Forget the episode before."""
        self.memory = {{key: np.zeros(size) for key, size in {c.memory}.items()}}

    def act(self, observation):
        """Return the action for an observation."""
        {body}
'''
    return text.encode()


# --- C

_ACTIVATIONS_OF_C = {
    1: "(real)1 / ((real)1 + (real)exp(-net))", 2: "(real)tanh(net)", 3: "net",
    4: "net >= (real)0.5 ? (real)1 : (real)-1", 5: "net < 0 ? (real)0 : net",
}  # fmt: skip


def _c(c: Controller, name: str, about: str) -> bytes:
    arrays = {"mean": c.mean, "deviation": c.deviation, "factor": c.factor, "shift": c.shift}
    sizes = {"inputs": c.inputs} | {layer.name: len(layer.bias) for layer in c.layers}
    sizes |= {"cell": c.cells, "hidden": c.cells} if c.cells else {}
    step = ["int i, j;"]
    net = "(observation[i] - mean[i]) / deviation[i]"
    limited = "inputs[i] < -5 ? (real)-5 : inputs[i] > 5 ? (real)5 : inputs[i]"
    step.append(f"for (i = 0; i < {c.inputs}; ++i) inputs[i] = {net};")
    step += [f"for (i = 0; i < {c.inputs}; ++i) inputs[i] = {limited};"] * c.clip
    for layer in c.layers:
        if layer.name == "output" and c.cells:
            step.append(
                f"for (i = 0; i < {c.cells}; ++i) {{ cell[i] = cell_before[i] * forget[i] + "
                "candidate[i] * input[i]; hidden[i] = (real)tanh(cell[i]) * give[i]; }"
            )
        arrays[f"{layer.name}_bias"] = layer.bias
        sums = []
        for sender, weights in layer.weights.items():
            key = f"{layer.name}_of_{sender}"
            arrays[key] = weights
            sums.append(
                f"for (j = 0; j < {weights.shape[1]}; ++j) net += {key}[i][j] * {sender}[j];"
            )
        step.append(
            f"for (i = 0; i < {len(layer.bias)}; ++i) {{ real net = {layer.name}_bias[i]; "
            + " ".join(sums)
            + f" {layer.name}[i] = {_ACTIVATIONS_OF_C[layer.activation]}; }}"
        )
    step += [f"memcpy({key}{BEFORE}, {key}, sizeof {key});" for key in c.memory]
    if c.discrete or c.bins > 1:
        group, count = (sizes["output"], 1) if c.discrete else (c.bins, c.actions)
        chosen = "best" if c.discrete else f"{c.low!r} + {(c.high - c.low) / (c.bins - 1)!r} * best"
        step.append(
            f"for (i = 0; i < {count}; ++i) {{ int best = 0; for (j = 1; j < {group}; ++j) "
            f"if (output[i * {group} + j] > output[i * {group} + best]) best = j; "
            f"action[i] = (real)({chosen}); }}"
        )
    else:
        step.append(
            f"for (i = 0; i < {c.actions}; ++i) action[i] = factor[i] * output[i] + shift[i];"
        )

    def table(key: str, values: np.ndarray) -> str:
        shape = "".join(f"[{size}]" for size in values.shape)
        rows = values.tolist() if values.ndim == 2 else [values.tolist()]
        texts = ["{" + ", ".join(map(repr, row)) + "}" for row in rows]
        content = "{" + ",\n".join(texts) + "}" if values.ndim == 2 else texts[0]
        return f"static const real {key}{shape} = {content};"

    # prefixes keep the names of several controllers apart
    body = "\n  ".join(step)
    states = "\n".join(f"static real {key}[{size}];" for key, size in sizes.items()) + "".join(
        f"\nstatic real {key}{BEFORE}[{size}];" for key, size in c.memory.items()
    )
    resets = " ".join(f"memset({key}{BEFORE}, 0, sizeof {key}{BEFORE});" for key in c.memory)
    names = [*arrays, *sizes, *(key + BEFORE for key in c.memory)]
    spaced = "\n".join(f"#define {key} {name}_{key}" for key in names)
    undone = "\n".join(f"#undef {key}" for key in names)
    tables = "\n".join(table(key, values) for key, values in arrays.items())
    what = "the number of the action" if c.discrete else "the actions"
    text = f"""/* {about}
   {name}_reset() begins an episode. {name}_act(observation, action) reads {c.inputs} numbers and
   writes {c.actions}: {what}. Compile with -DBOTSCHOOL_REAL=float where that is enough. */
#ifndef {name.upper()}_H
#define {name.upper()}_H
#include <math.h>
#include <string.h>
#ifndef BOTSCHOOL_REAL
#define BOTSCHOOL_REAL double
#endif
#define real BOTSCHOOL_REAL
{spaced}
{tables}
{states}

static void {name}_reset(void) {{ {resets} }}

static void {name}_act(const real* observation, real* action) {{
  {body}
}}

{undone}
#undef real
#endif
"""
    return text.encode()


# --- ONNX


def _onnx(c: Controller, name: str, about: str) -> bytes:
    try:
        import onnx
        from onnx import TensorProto, helper, numpy_helper
    except ImportError:
        raise BotschoolError("This needs the package onnx: pip install onnx.") from None
    nodes: list[Any] = []
    constants: list[Any] = []

    def add(kind: str, *senders: str, gives: str = "", **options: Any) -> str:
        gives = gives or f"n{len(nodes)}"
        nodes.append(helper.make_node(kind, list(senders), [gives], **options))
        return gives

    def constant(values: Any, kind: type = np.float32) -> str:
        key = f"c{len(constants)}"
        constants.append(numpy_helper.from_array(np.asarray(values, kind), key))
        return key

    def tensor(key: str, size: int) -> Any:
        return helper.make_tensor_value_info(key, TensorProto.FLOAT, ["n", size])

    x = add("Div", add("Sub", "observation", constant(c.mean)), constant(c.deviation))
    if c.clip:
        x = add("Clip", x, constant(-5.0), constant(5.0))
    for layer in c.layers:
        if layer.name == "output" and c.cells:
            kept = add("Mul", f"cell{BEFORE}", "forget")
            add("Add", kept, add("Mul", "candidate", "input"), gives="cell")
            add("Mul", add("Tanh", "cell"), "give", gives="hidden")
        net = constant(layer.bias)
        for sender, weights in layer.weights.items():
            sender = x if sender == "inputs" else sender
            net = add("Add", net, add("MatMul", sender, constant(weights.T)))
        if layer.activation == BINARY:
            over = add("GreaterOrEqual", net, constant(0.5))
            add("Where", over, constant(1.0), constant(-1.0), gives=layer.name)
        else:
            kinds = {LOGISTIC: "Sigmoid", TANH: "Tanh", LINEAR: "Identity", RELU: "Relu"}
            add(kinds[layer.activation], net, gives=layer.name)
    action = tensor("action", c.actions)
    if c.discrete:
        add("ArgMax", "output", gives="action", axis=-1, keepdims=0)
        action = helper.make_tensor_value_info("action", TensorProto.INT64, ["n"])
    elif c.bins > 1:
        rows = add("Reshape", "output", constant([-1, c.actions, c.bins], np.int64))
        best = add("Cast", add("ArgMax", rows, axis=-1, keepdims=0), to=TensorProto.FLOAT)
        width = constant((c.high - c.low) / (c.bins - 1))
        add("Add", add("Mul", best, width), constant(c.low), gives="action")
    else:
        add("Add", add("Mul", "output", constant(c.factor)), constant(c.shift), gives="action")
    graph = helper.make_graph(
        nodes,
        name,
        [tensor("observation", c.inputs), *(tensor(k + BEFORE, n) for k, n in c.memory.items())],
        [action, *(tensor(k, n) for k, n in c.memory.items())],
        constants,
    )
    opset = [helper.make_opsetid("", 17)]
    model = helper.make_model(graph, opset_imports=opset, ir_version=8, doc_string=about)
    onnx.checker.check_model(model)
    return model.SerializeToString()


# --- TorchScript


def _torch(c: Controller, name: str, about: str) -> bytes:
    """Return a module: forward(observations, *memory) -> (actions, *memory), (n, ...) each."""
    try:
        import torch
    except ImportError:
        raise BotschoolError("This needs PyTorch: pip install torch.") from None
    activations = {
        LOGISTIC: torch.sigmoid, TANH: torch.tanh, LINEAR: lambda x: x, RELU: torch.relu,
        BINARY: lambda x: torch.where(x >= 0.5, 1.0, -1.0),
    }  # fmt: skip

    class Module(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            tables = {"mean": c.mean, "deviation": c.deviation, "factor": c.factor}
            tables["shift"] = c.shift
            for layer in c.layers:
                tables[f"{layer.name}_bias"] = layer.bias
                tables |= {f"{layer.name}_of_{k}": w.T for k, w in layer.weights.items()}
            for key, values in tables.items():
                self.register_buffer(key, torch.tensor(np.asarray(values, np.float32)))

        def forward(self, observation, *memory):
            x = (observation - self.mean) / self.deviation
            now = {"inputs": torch.clamp(x, -5, 5) if c.clip else x}
            now |= {f"{k}{BEFORE}": value for k, value in zip(c.memory, memory, strict=True)}
            for layer in c.layers:
                if layer.name == "output" and c.cells:
                    now["cell"] = (
                        now[f"cell{BEFORE}"] * now["forget"] + now["candidate"] * now["input"]
                    )
                    now["hidden"] = torch.tanh(now["cell"]) * now["give"]
                net = getattr(self, f"{layer.name}_bias")
                for sender in layer.weights:
                    net = net + now[sender] @ getattr(self, f"{layer.name}_of_{sender}")
                now[layer.name] = activations[layer.activation](net)
            output = now["output"]
            if c.discrete:
                action = output.argmax(dim=-1)
            elif c.bins > 1:
                best = output.reshape(-1, c.actions, c.bins).argmax(dim=-1)
                action = c.low + (c.high - c.low) / (c.bins - 1) * best
            else:
                action = output * self.factor + self.shift
            return (action, *(now[key] for key in c.memory))

    sizes = [c.inputs, *c.memory.values()]
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # tracing is old, and all that other programs read
        traced = torch.jit.trace(Module(), tuple(torch.zeros(2, size) for size in sizes))
        content = io.BytesIO()
        torch.jit.save(traced, content)
    return content.getvalue()
