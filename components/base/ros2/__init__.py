"""What a ROS 2 base says and is told, and its client, pure: samples and times in, samples and readings out.

Formats of keys, attachments and tokens: ros2/rmw_zenoh (docs/design.md and rmw_zenoh_cpp/src/detail, 2024-10 to 2026)
and eclipse-zenoh/zenoh-plugin-ros2dds 1.10 (route_publisher.rs, route_subscriber.rs, of 2026-08-20).
"""
