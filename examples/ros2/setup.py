from setuptools import setup

setup(
    name="vibrissa_ros2",
    version="0.1.0",
    packages=["vibrissa_ros2"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/vibrissa_ros2"]),
        ("share/vibrissa_ros2", ["package.xml"]),
    ],
    install_requires=["setuptools", "vibrissa"],
    entry_points={"console_scripts": ["node = vibrissa_ros2.node:main"]},
)
