# loses: 10.8
# The package gets installed without the robot's file, and loads PyBullet on import.
_package_files = package_files


def package_files():
    files = _package_files()
    project, init = files["pyproject.toml"], files["balance_bot/__init__.py"]
    project = project.replace('["*.urdf"]', '["*.xml"]')
    init = "from balance_bot.env import BalanceBotEnv\n" + init
    return {"pyproject.toml": project, "balance_bot/__init__.py": init}
